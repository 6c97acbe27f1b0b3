#include "common.h"
// rest E damp sub kind T : box/ball/stack at rest, prints kinetic speed each second, sleep
int main(int c,char**v){ double E=atof(v[1]),damp=atof(v[2]); int sub=atoi(v[3]); int kind=atoi(v[4]); double T=atof(v[5]);
 DeformableWorld world; world.setGravity({0,-9.81f,0}); world.getWorldInfo().m_gravity.setValue(0,-9.81f,0);
 auto floor=addRigid(world,new btBoxShape({50,1,50}),0,{0,-1,0}); (*floor)->setFriction(.5);
 Model m=makeModel(kind==1?sphereMesh(.2,20):boxMesh({.15,.15,.15},6),500); SoftContacts::Options so; auto soft=std::make_unique<SoftContacts>(so); 
 SoftBodyOptions o; o.density=200; o.youngsModulus=E; o.stiffnessDamping=damp; o.friction=.5;
 std::vector<std::unique_ptr<Soft>> s; int n=kind==2?3:1; for(int k=0;k<n;k++) s.push_back(addSoft(world,m,{0,btScalar((kind==1?.2:.15)+.05+.32*k),0},o,n>1?soft.get():nullptr));
 if(n>1) world.addForce(soft.get());
 double dt=1.0/60/sub; printf("E %.0e damp %.3f sub %d kind %d:",E,damp,sub,kind); double slept=-1; for(int i=0;i<int(T*60*sub);i++){ world.stepSimulation(dt,1,dt); if(slept<0&&!s[n-1]->body().isActive())slept=i*dt; if(i%(60*sub)==0) printf(" %.4f",vmax(s[n-1]->body())); } printf(" slept %.2f y %.3f\n",slept,com(s[n-1]->body()).y());
}
