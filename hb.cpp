#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <algorithm>
#include <vector>
#include <map>
#include "carom/kernel/tolerance.h"
#include "carom/kernel/march.h"
#include "support/batch_arrays.h"
#include "support/random_impacts.h"
using namespace carom; using namespace carom::kernel; using namespace carom::test;
static double now(){timespec t;clock_gettime(CLOCK_THREAD_CPUTIME_ID,&t);return t.tv_sec*1e9+t.tv_nsec;}
int main(int c,char**v){
  int rounds=c>1?atoi(v[1]):200;
  auto list=random_impacts(1,2000);
  BatchArrays a(list,ClothSlip::kConsistent);
  std::vector<ToleranceMethod> meth(2000); 
  std::vector<ImpactResult> res(2000);
  const Isa isas[2]={Isa::kV3,Isa::kV4}; const double tol[3]={1e-3,1e-6,1e-10};
  double best[6],single[6],base=1e30; for(auto&b:best)b=1e30; for(auto&b:single)b=1e30;
  int lo=0,hi=6; if(c>2){lo=atoi(v[2]);hi=lo+1;}
  for(int r=0;r<rounds;++r) { for(int k=lo;k<hi;++k){
    double t=now(); tolerance_batch_function(isas[k/3])(a.batch,tol[k%3],a.result); t=(now()-t)/2000; best[k]=std::min(best[k],t);
  }
  if(hi-lo>1&&r%10==0){ double t=now(); for(int i=0;i<50;++i) march_function(Isa::kV3)(list[i].ball1,list[i].ball2,list[i].params,1000,res[i]); t=(now()-t)/50; base=std::min(base,t);} }
  for(int k=lo;k<hi;++k) printf("v%d %g: %.1f ns  %.0fx\n",3+k/3,tol[k%3],best[k],22300/best[k]);
  printf("base %.0f\n",base);
  if(c>3){ BatchArrays b(list,ClothSlip::kConsistent); b.result.method=meth.data();
   for(double t:tol){ std::map<int,std::map<int,int>> h; tolerance_batch_function(Isa::kV4)(b.batch,t,b.result);
    for(int i=0;i<2000;++i) h[(int)meth[i]][std::min(60l,b.result.steps[i])]++;
    for(auto&[m,hh]:h){printf("%g %s:",t,name((ToleranceMethod)m)); int n=0; for(auto&[k,x]:hh){n+=x;printf(" %d:%d",k,x);} printf(" = %d\n",n);} } }
}
