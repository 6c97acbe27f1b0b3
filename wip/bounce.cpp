#include "common.h"
#include <Eigen/SVD>
// usage: bounce E damping substeps [mode] [h] [seconds] [verbose]
struct Energy{ std::vector<Eigen::Matrix3d> inv; std::vector<double> vol; double mu,la; const Cage*c;
 Energy(const Cage&cage,const SoftBodyOptions&o,double E,double nu):c(&cage){ mu=E/(2*(1+nu)); la=E*nu/((1+nu)*(1-2*nu)); auto full=withCageDefaults(cage,o);
  for(std::size_t t=0;t<cage.mesh.tets.size();t++){auto&T=cage.mesh.tets[t]; Eigen::Matrix3d D; for(int k=0;k<3;k++)D.col(k)=cage.mesh.nodes[T[k+1]]-cage.mesh.nodes[T[0]]; inv.push_back(D.inverse()); double s=full.stiffnessScale.empty()?1:full.stiffnessScale[t]; vol.push_back(std::abs(D.determinant())/6*s);} }
 double of(const btSoftBody&b){ double e=0; for(std::size_t t=0;t<inv.size();t++){auto&T=c->mesh.tets[t]; Eigen::Matrix3d D; V3 x0=toEigen(b.m_nodes[T[0]].m_x); for(int k=0;k<3;k++)D.col(k)=toEigen(b.m_nodes[T[k+1]].m_x)-x0; Eigen::Matrix3d F=D*inv[t]; Eigen::JacobiSVD<Eigen::Matrix3d> s(F,Eigen::ComputeFullU|Eigen::ComputeFullV); V3 d=s.singularValues(); if((s.matrixU()*s.matrixV().transpose()).determinant()<0)d[2]=-d[2]; double tr=(d-V3::Ones()).sum(); e+=vol[t]*(mu*(d-V3::Ones()).squaredNorm()+la/2*tr*tr);} return e; } };
int main(int c,char**v){
  double E=atof(v[1]),damp=atof(v[2]); int sub=atoi(v[3]); std::string mode=c>4?v[4]:"static"; double h=c>5?atof(v[5]):2; double T=c>6?atof(v[6]):2.5; int verb=c>7?atoi(v[7]):0;
  double rest=getenv("REST")?atof(getenv("REST")):0;
  DeformableWorld world; world.setGravity({0,-9.81f,0}); world.getWorldInfo().m_gravity.setValue(0,-9.81f,0);
  auto floor=addRigid(world,new btBoxShape({5,1,5}),0,{0,-1,0}); (*floor)->setRestitution(rest);
  TriangleMesh mesh=sphereMesh(.2,20); CageOptions co; co.targetTets=getenv("TETS")?atoi(getenv("TETS")):400; auto cage=createCage(mesh,co).value();
  SoftBodyOptions o; o.density=200; o.youngsModulus=E; o.stiffnessDamping=damp;
  auto bind=SoftBodyBinding::create(cage,mesh).value();
  auto b=DeformableBody::add(world,cage,o).value(); b->body().translate({0,btScalar(h+.2),0}); b->body().setRestitution(rest);
  SurfaceContactOptions so; auto sc=SurfaceContact::add(world,b->body(),*bind,mesh,so).value();
  Energy en(cage,o,E,.3);
  double g=9.81,m=bodyMass(b->body()),y0=com(b->body()).y()-h; double dt=1.0/60/sub; double low=1e9,reb=-1e9; bool hit=false; double e0=0,emax=0,emin=1e9; double prev=1e300,grow=0,sumgrow=0; long it=0; double t0=cpu(); double eAfter=0; int steps=0,un=0; double vmin=0;
  int N=int(T*60*sub);
  int split=getenv("SPLIT")?atoi(getenv("SPLIT")):1; int splits=0; for(int i=0;i<N;i++){ bool near=split>1&&com(b->body()).y()-y0<(vel(b->body()).y()<0?.05:.04); if(near)splits++; for(int q=0;q<(near?split:1);q++) world.stepSimulation(near?dt/split:dt,1,near?dt/split:dt); steps++; it+=world.deformableSolver().iterations(); un+=world.deformableSolver().unconvergedSystems();
    auto&B=b->body(); double y=com(B).y()-y0; double vy=vel(B).y(); if(vy<vmin)vmin=vy;
    if(y<low)low=y; if(vy>0&&low<.1*h) hit=true; if(hit&&y>reb)reb=y; if(hit&&vy<0&&y>.001&&mode=="static"&&T==2.5&&reb>0.0&&i>N/3&&y<reb-.02){break;}
    if(verb){ double k=kin(B),el=en.of(B),p=m*g*y; double tot=k+el+p; 
      if(verb==1&&i%(std::max(1,sub/4))==0) printf("%.4f y %.4f vy %.3f kin %.2f el %.2f tot %.3f it %d act %d\n",i*dt,y,vy,k,el,tot,world.deformableSolver().iterations(),B.isActive());
      if(i==0)e0=tot; if(tot>emax)emax=tot; if(tot>prev){grow=std::max(grow,(tot-prev)/e0);sumgrow+=(tot-prev)/e0;} prev=tot; } }
  printf("E %.0e damp %.3f sub %d: rebound %.3f low %.3f  its/step %.1f unconv %d cpu %.2f tets %zu",E,damp,sub,reb,low,double(it)/steps,un,cpu()-t0,cage.mesh.tets.size());
  if(verb)printf(" emax/e0 %.4f largest growth per step %.5f sum %.5f",emax/e0,grow,sumgrow); if(split>1)printf(" split steps %d",splits); puts("");
  sc.reset(); b.reset(); floor.reset(); }
