// What Mesa keeps until the process ends is not ours to free.
#if defined(__SANITIZE_ADDRESS__)
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
    return "leak:libOSMesa\nleak:libEGL\nleak:libgallium\nleak:_dri.so\nleak:libLLVM\n";
}
#endif
