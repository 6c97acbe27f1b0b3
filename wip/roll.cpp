#include "common.h"
// roll E damping substeps tets meshdiv seconds
int main(int c,char**v){ double E=atof(v[1]),damp=atof(v[2]); int sub=atoi(v[3]); int tets=c>4?atoi(v[4]):1300; int div=c>5?atoi(v[5]):20; double T=c>6?atof(v[6]):2;
 double sl=10*M_PI/180; btVector3 g(btScalar(9.81*sin(sl)),btScalar(-9.81*cos(sl)),0);
 DeformableWorld world; world.setGravity(g); world.getWorldInfo().m_gravity=g;
 auto floor=addRigid(world,new btBoxShape({50,1,50}),0,{0,-1,0}); (*floor)->setFriction(1);
 TriangleMesh mesh=sphereMesh(.2,div); CageOptions co; co.targetTets=tets; auto cage=createCage(mesh,co).value();
 SoftBodyOptions o; o.density=200; o.youngsModulus=E; o.stiffnessDamping=damp; o.friction=1;
 auto bind=SoftBodyBinding::create(cage,mesh).value();
 auto b=DeformableBody::add(world,cage,o).value(); b->body().translate({0,btScalar(.202),0});
 auto sc=SurfaceContact::add(world,b->body(),*bind,mesh,{}).value();
 double x0=com(b->body()).x(); double dt=1.0/60/sub; long it=0; double t0=cpu(); int N=int(T*60*sub);
 for(int i=0;i<N;i++){ world.stepSimulation(dt,1,dt); it+=world.deformableSolver().iterations(); }
 double way=(com(b->body()).x()-x0)/(5.0/14*9.81*T*T*sin(sl));
 printf("E %.0e damp %.3f sub %d tets %zu div %d: way %.4f its %.2f cpu %.2f\n",E,damp,sub,cage.mesh.tets.size(),div,way,double(it)/N,cpu()-t0);
 sc.reset(); b.reset(); floor.reset(); }
