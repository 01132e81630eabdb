// LeakSanitizer names a leak's module only while that is loaded. The validation layer leaks, so it stays loaded and is
// named here; everything else is reported.
#include <dlfcn.h>

extern "C" const char* __lsan_default_suppressions() { return "leak:libVkLayer_khronos_validation.so\n"; }
extern "C" const char* __lsan_default_options() { return "print_suppressions=0"; }

namespace {

[[maybe_unused]] void* const validation_layer =
    dlopen("libVkLayer_khronos_validation.so", RTLD_LAZY | RTLD_LOCAL | RTLD_NODELETE);

}  // namespace
