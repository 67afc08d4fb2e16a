// Comments in the assembly around a loop's body, for tools/measure/mca_kernel.py; nothing in a build.
#pragma once

#ifdef CAROM_LOOP_MARKS
#define CAROM_LOOP_BEGIN(name) asm volatile("# LLVM-MCA-BEGIN " name)
#define CAROM_LOOP_END(name) asm volatile("# LLVM-MCA-END " name)
#else
#define CAROM_LOOP_BEGIN(name)
#define CAROM_LOOP_END(name)
#endif
