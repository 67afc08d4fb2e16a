// Comments in the assembly around the body of a loop, for lab/measure/mca_kernel.py. Empty in a normal build,
// which does not define CAROM_LOOP_MARKS.
#pragma once

#ifdef CAROM_LOOP_MARKS
#define CAROM_LOOP_BEGIN(name) asm volatile("# LLVM-MCA-BEGIN " name)
#define CAROM_LOOP_END(name) asm volatile("# LLVM-MCA-END " name)
#else
#define CAROM_LOOP_BEGIN(name)
#define CAROM_LOOP_END(name)
#endif
