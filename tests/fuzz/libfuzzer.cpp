// One target, TWINRAY_FUZZ_TARGET, as libFuzzer calls it.
#include <cstddef>

#include "tests/fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    twinray::fuzz::TWINRAY_FUZZ_TARGET({data, size});
    return 0;
}

// Mesa's driver leaks a little for each device, not for each input.
extern "C" const char* __lsan_default_suppressions() { return "leak:libvulkan_lvp.so\n"; }
extern "C" const char* __lsan_default_options() { return "print_suppressions=0"; }
