#include "validation/cpu_reference/flush_denormals.h"

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace twinray {
namespace {

#if defined(__SSE2__)
constexpr bool able = true;
constexpr unsigned long flush = 0x8040;  // MXCSR: flush to zero, denormals are zero
unsigned long control_register() { return _mm_getcsr(); }
void set_control_register(unsigned long value) { _mm_setcsr(static_cast<unsigned>(value)); }
#elif defined(__aarch64__)
constexpr bool able = true;
constexpr unsigned long flush = 1ul << 24;  // FPCR.FZ
unsigned long control_register() {
    unsigned long value = 0;
    asm volatile("mrs %0, fpcr" : "=r"(value));
    return value;
}
void set_control_register(unsigned long value) { asm volatile("msr fpcr, %0" : : "r"(value)); }
#else
constexpr bool able = false;
constexpr unsigned long flush = 0;
unsigned long control_register() { return 0; }
void set_control_register(unsigned long) {}
#endif

}  // namespace

bool FlushDenormals::is_able() { return able; }

FlushDenormals::FlushDenormals() : saved_(control_register()) { set_control_register(saved_ | flush); }

FlushDenormals::~FlushDenormals() { set_control_register(saved_); }

}  // namespace twinray
