import math,sys
from vehiclemodels.parameters_vehicle2 import parameters_vehicle2
from vehiclemodels.init_mb import init_mb
from vehiclemodels.vehicle_dynamics_mb import vehicle_dynamics_mb
p=parameters_vehicle2()
print('#m',p.m,'a',p.a,'b',p.b,'Iz',p.I_z,'Tf',p.T_f,'h',p.h_cg,'Rw',p.R_w,'Iys',p.I_y_s,'Iphi',p.I_Phi_s,'ms',p.m_s,'muf',p.m_uf, 'Ksf',p.K_sf,'Kdf',p.K_sdf,file=sys.stderr)
v=float(sys.argv[1]); amp=float(sys.argv[2]); f=0.25; dt=0.0005; T=8.0
x=init_mb([0.0,0.0,0.0,v,0.0,0.0,0.0],p)
def F(x,t):
    u=[amp*2*math.pi*f*math.cos(2*math.pi*f*t), max(-3,min(3,2*(v-x[3])))]
    return vehicle_dynamics_mb(x,u,p)
n=int(T/dt+0.5)
print('time_s,steering_rad,x_m,y_m,yaw_rad,yaw_rate_radps,speed_mps')
for i in range(n+1):
    t=i*dt
    if i%100==0: print(f'{t:.2f},{x[2]:.8f},{x[0]:.5f},{x[1]:.5f},{x[4]:.7f},{x[5]:.7f},{x[3]:.5f}')
    k1=F(x,t); x2=[a+dt/2*b for a,b in zip(x,k1)]; k2=F(x2,t+dt/2); x3=[a+dt/2*b for a,b in zip(x,k2)]; k3=F(x3,t+dt/2); x4=[a+dt*b for a,b in zip(x,k3)]; k4=F(x4,t+dt)
    x=[a+dt/6*(b+2*c+2*d+e) for a,b,c,d,e in zip(x,k1,k2,k3,k4)]
