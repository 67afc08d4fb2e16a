W=/work/wt-batch; cd /tmp/hb
F="-O3 -DNDEBUG -std=c++20 -ffp-contract=off -fno-math-errno -Wno-psabi -g -I$W/kernel/include -I$W/kernel/src -I$W/tests"
(g++ $F -march=x86-64-v3 -c $W/kernel/src/tolerance_v3.cpp -o v3.o) & (g++ $F -march=x86-64-v4 -c $W/kernel/src/tolerance_v4.cpp -o v4.o); wait
[ -f rest.a ] || { for f in tolerance tolerance_scalar dispatch march_scalar closed_forms march_v4; do m=; [ $f = march_v4 ] && m=-march=x86-64-v4; g++ $F $m -c $W/kernel/src/$f.cpp -o r_$f.o; done; g++ $F -march=x86-64-v3 -c $W/kernel/src/march_v3.cpp -o r_march_v3.o; ar rcs rest.a r_*.o; }
[ -f hb.o ] || g++ $F -c hb.cpp -o hb.o
g++ hb.o v3.o v4.o rest.a -o ${1:-hb}
