#include "common.h"
// land E damping: a tilted bar falls .2 m; error of surface vs own 64 substeps, RMS over frames 30..120, % of size
std::vector<std::vector<V3>> run(double E,double damp,int sub,int shape,int frames,long*it){
 DeformableWorld world; world.setGravity({0,-9.81f,0}); world.getWorldInfo().m_gravity.setValue(0,-9.81f,0);
 auto floor=addRigid(world,new btBoxShape({50,1,50}),0,{0,-1,0}); (*floor)->setFriction(.5);
 TriangleMesh mesh=shape==0?boxMesh({.5,.06,.06},6):shape==1?torusMesh(.3,.08):sphereMesh(.2,20); CageOptions co; co.targetTets=1000; auto cage=createCage(mesh,co).value();
 SoftBodyOptions o; o.density=200; o.youngsModulus=E; o.stiffnessDamping=damp; o.friction=.5;
 auto bind=SoftBodyBinding::create(cage,mesh).value();
 auto b=DeformableBody::add(world,cage,o).value(); b->body().rotate(btQuaternion(btVector3(0,0,1),.4)); 
 double lo=1e9; for(int i=0;i<b->body().m_nodes.size();i++) lo=std::min(lo,(double)b->body().m_nodes[i].m_x.y());
 b->body().translate({0,btScalar(.2-lo),0});
 auto sc=SurfaceContact::add(world,b->body(),*bind,mesh,{}).value();
 std::vector<std::vector<V3>> out; double dt=1.0/60/sub; 
 for(int f=0;f<frames;f++){ for(int s=0;s<sub;s++){world.stepSimulation(dt,1,dt); *it+=world.deformableSolver().iterations();} std::vector<V3> p; for(int i=0;i<b->body().m_nodes.size();i++)p.push_back(toEigen(b->body().m_nodes[i].m_x)); out.push_back(p);} 
 sc.reset(); b.reset(); floor.reset(); return out; }
int main(int c,char**v){ double E=atof(v[1]),damp=atof(v[2]); int shape=atoi(v[3]); int F=120; long it=0; setenv("TS_ALL","1",1); auto ref=run(E,damp,c>4?atoi(v[4]):64,shape,F,&it); 
 if(getenv("BE")) unsetenv("TS_ALL"); for(int s:{1,2,4,8,16}){ printf("E %.0e damp %.3f shape %d sub %2d:",E,damp,shape,s);  { long k=0; double t0=cpu(); auto r=run(E,damp,s,shape,F,&k); double e=0; int n=0; double e2=0;int n2=0; for(int f=0;f<F;f++) for(size_t i=0;i<r[f].size();i++){ double q=(r[f][i]-ref[f][i]).squaredNorm(); if(f<60){e+=q;n++;} else {e2+=q;n2++;} } printf(" err first s %.3f%% second %.3f%% it %ld cpu %.2f",100*sqrt(e/n),100*sqrt(e2/n2),k/(s*F),cpu()-t0);} puts(""); fflush(stdout); } }
