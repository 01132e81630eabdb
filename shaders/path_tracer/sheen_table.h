// SPDX-License-Identifier: MIT
// Directional albedo of white sheen as glTF has it (Charlie's distribution, Estevez and Kulla's shadowing), by
// quadrature of 500 x 500 directions, raised so that linear interpolation between the nodes is never too low; it is at
// most 0.083 too high. A line is a roughness, 0.1 + 0.9 (j / 9)^2, an entry of it a cosine, (i / 11)^2; at cosine 0,
// the greatest near it.
#ifndef TWINRAY_PATH_TRACER_SHEEN_TABLE_H
#define TWINRAY_PATH_TRACER_SHEEN_TABLE_H

const uint SHEEN_COSINES = 12u;
const uint SHEEN_ROUGHNESSES = 10u;
const float SHEEN_UNIT = 8192.0f;  // of the table
const uint SHEEN_ALBEDO[120] = {
    18027u, 16972u, 10851u, 6031u, 2787u, 1016u, 266u,  44u,   4u,    1u,     1u,     1u,    16356u, 15640u, 10370u,
    6047u,  3011u,  1224u,  378u,  79u,   9u,    1u,    1u,    1u,    12939u, 12613u, 9098u, 5902u,  3420u,  1727u,
    727u,   237u,   53u,    7u,    1u,    1u,    9851u, 9739u, 7717u, 5518u,  3673u,  2243u, 1225u,  573u,   215u,
    58u,    8u,     1u,     7869u, 7886u, 6651u, 5123u, 3773u, 2631u, 1712u,  1014u,  524u,  224u,   66u,    4u,
    6836u,  6867u,  6052u,  4940u, 3897u, 2969u, 2164u, 1485u, 937u,  528u,   237u,   49u,   6545u,  6700u,  6038u,
    5074u,  4190u,  3380u,  2650u, 1996u, 1419u, 946u,  552u,  221u,  6848u,  7029u,  6442u, 5531u,  4695u,  3924u,
    3219u,  2563u,  1959u,  1441u, 982u,  555u,  7494u, 7874u, 7184u, 6250u,  5373u,  4584u, 3853u,  3168u,  2522u,
    1971u,  1468u,  996u,   7634u, 7992u, 7340u, 6418u, 5568u, 4804u, 4103u,  3448u,  2830u, 2299u,  1816u,  1359u};
#endif
