#include "common.h"
#include <Eigen/SVD>
struct Energy{ std::vector<Eigen::Matrix3d> inv; std::vector<double> vol; double mu,la; const Cage*c;
 Energy(const Cage&cage,const SoftBodyOptions&o,double E,double nu):c(&cage){ mu=E/(2*(1+nu)); la=E*nu/((1+nu)*(1-2*nu)); auto full=withCageDefaults(cage,o);
  for(std::size_t t=0;t<cage.mesh.tets.size();t++){auto&T=cage.mesh.tets[t]; Eigen::Matrix3d D; for(int k=0;k<3;k++)D.col(k)=cage.mesh.nodes[T[k+1]]-cage.mesh.nodes[T[0]]; inv.push_back(D.inverse()); double s=full.stiffnessScale.empty()?1:full.stiffnessScale[t]; vol.push_back(std::abs(D.determinant())/6*s);} }
 double of(const btSoftBody&b){ double e=0; for(std::size_t t=0;t<inv.size();t++){auto&T=c->mesh.tets[t]; Eigen::Matrix3d D; V3 x0=toEigen(b.m_nodes[T[0]].m_x); for(int k=0;k<3;k++)D.col(k)=toEigen(b.m_nodes[T[k+1]].m_x)-x0; Eigen::Matrix3d F=D*inv[t]; Eigen::JacobiSVD<Eigen::Matrix3d> s(F,Eigen::ComputeFullU|Eigen::ComputeFullV); V3 d=s.singularValues(); if((s.matrixU()*s.matrixV().transpose()).determinant()<0)d[2]=-d[2]; double tr=(d-V3::Ones()).sum(); e+=vol[t]*(mu*(d-V3::Ones()).squaredNorm()+la/2*tr*tr);} return e; } };
// en E damp sub shape tilt height frames verbose
int main(int c,char**v){ double E=atof(v[1]),damp=atof(v[2]); int sub=atoi(v[3]),shape=atoi(v[4]); double tilt=atof(v[5]),h=atof(v[6]); int F=atoi(v[7]); int verb=c>8?atoi(v[8]):0;
 DeformableWorld world; world.setGravity({0,-9.81f,0}); world.getWorldInfo().m_gravity.setValue(0,-9.81f,0);
 auto floor=addRigid(world,new btBoxShape({50,1,50}),0,{0,-1,0}); (*floor)->setFriction(.5);
 TriangleMesh mesh=shape==0?boxMesh({.5,.06,.06},6):shape==1?torusMesh(.3,.08):shape==3?boxMesh({.15,.15,.15},6):sphereMesh(.2,20); CageOptions co; co.targetTets=getenv("TETS")?atoi(getenv("TETS")):1000; auto cage=createCage(mesh,co).value();
 SoftBodyOptions o; o.density=200; o.youngsModulus=E; o.stiffnessDamping=damp; o.friction=.5;
 auto bind=SoftBodyBinding::create(cage,mesh).value();
 auto b=DeformableBody::add(world,cage,o).value(); b->body().rotate(btQuaternion(btVector3(0,0,1),tilt)); 
 double lo=1e9; for(int i=0;i<b->body().m_nodes.size();i++) lo=std::min(lo,(double)b->body().m_nodes[i].m_x.y());
 b->body().translate({0,btScalar(h-lo),0});
 auto sc=SurfaceContact::add(world,b->body(),*bind,mesh,{}).value();
 Energy en(cage,o,E,.3); double dt=1.0/60/sub,m=bodyMass(b->body()); double e0=0,mx=0,prev=1e9,grow=0; 
 for(int f=0;f<F;f++) for(int s=0;s<sub;s++){ world.stepSimulation(dt,1,dt); auto&B=b->body(); double k=kin(B),el=en.of(B),p=m*9.81*com(B).y(),t=k+el+p; if(!e0)e0=t; mx=std::max(mx,t); grow=std::max(grow,t-prev); prev=t; if(verb)printf("%d.%d kin %.3f el %.3f pot %.3f tot %.3f its %d y %.3f\n",f,s,k,el,p,t,world.deformableSolver().iterations(),com(B).y()); }
 printf("E %.0e damp %.3f sub %d shape %d tilt %.2f h %.2f: emax/e0 %.4f largest step %.4f end %.4f\n",E,damp,sub,shape,tilt,h,mx/e0,grow/e0,prev/e0);
 sc.reset(); b.reset(); floor.reset(); }
