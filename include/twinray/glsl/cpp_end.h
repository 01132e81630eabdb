// SPDX-License-Identifier: MIT
// Undefines the vocabulary of cpp_begin.h.
#undef FUNC
#undef TWINRAY_REFINED
#undef INOUT
#undef PRECISE
#undef REF
#undef AT
#undef BUFFER_OF
#undef FMA
#undef FUSED
#undef COUNT_STEPS
#undef UNROLL
#undef DONT_UNROLL
