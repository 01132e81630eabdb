// SPDX-License-Identifier: MIT
// Closes what cpp_begin.h opened.
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
