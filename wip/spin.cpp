#include "common.h"
#include <Eigen/SVD>
struct Energy{ std::vector<Eigen::Matrix3d> inv; std::vector<double> vol; double mu,la; const Cage*c;
 Energy(const Cage&cage,const SoftBodyOptions&o,double E,double nu):c(&cage){ mu=E/(2*(1+nu)); la=E*nu/((1+nu)*(1-2*nu)); auto full=withCageDefaults(cage,o);
  for(std::size_t t=0;t<cage.mesh.tets.size();t++){auto&T=cage.mesh.tets[t]; Eigen::Matrix3d D; for(int k=0;k<3;k++)D.col(k)=cage.mesh.nodes[T[k+1]]-cage.mesh.nodes[T[0]]; inv.push_back(D.inverse()); double s=full.stiffnessScale.empty()?1:full.stiffnessScale[t]; vol.push_back(std::abs(D.determinant())/6*s);} }
 double of(const btSoftBody&b){ double e=0; for(std::size_t t=0;t<inv.size();t++){auto&T=c->mesh.tets[t]; Eigen::Matrix3d D; V3 x0=toEigen(b.m_nodes[T[0]].m_x); for(int k=0;k<3;k++)D.col(k)=toEigen(b.m_nodes[T[k+1]].m_x)-x0; Eigen::Matrix3d F=D*inv[t]; Eigen::JacobiSVD<Eigen::Matrix3d> s(F,Eigen::ComputeFullU|Eigen::ComputeFullV); V3 d=s.singularValues(); if((s.matrixU()*s.matrixV().transpose()).determinant()<0)d[2]=-d[2]; double tr=(d-V3::Ones()).sum(); e+=vol[t]*(mu*(d-V3::Ones()).squaredNorm()+la/2*tr*tr);} return e; } };
int main(int c,char**v){ double E=atof(v[1]); int sub=atoi(v[2]); double w=atof(v[3]); double squeeze=atof(v[4]);
 DeformableWorld world; world.setGravity({0,0,0}); world.getWorldInfo().m_gravity.setValue(0,0,0);
 TriangleMesh mesh=boxMesh({.15,.15,.15},6); CageOptions co; co.targetTets=400; auto cage=createCage(mesh,co).value();
 SoftBodyOptions o; o.density=200; o.youngsModulus=E; o.stiffnessDamping=0;
 auto b=DeformableBody::add(world,cage,o).value(); Energy en(cage,o,E,.3);
 for(int i=0;i<b->body().m_nodes.size();i++){ auto&n=b->body().m_nodes[i]; V3 p=toEigen(n.m_x); V3 vel=V3(.3,.5,.8).normalized().cross(p)*w+V3(squeeze*p.x(),-squeeze*p.y()*.5,0); n.m_v.setValue(vel[0],vel[1],vel[2]); n.m_vn=n.m_v; }
 double e0=0,mx=0; for(int i=0;i<120*sub;i++){ world.stepSimulation(1./60/sub,1,1./60/sub); double t=kin(b->body())+en.of(b->body()); if(!e0)e0=t; mx=std::max(mx,t);} printf("E %.0e sub %d w %.0f squeeze %.1f: max/e0 %.3f end %.3f\n",E,sub,w,squeeze,mx/e0,(kin(b->body())+en.of(b->body()))/e0); }
