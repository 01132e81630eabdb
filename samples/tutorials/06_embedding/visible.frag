// SPDX-License-Identifier: MIT
#version 460
layout(location = 0) flat in uvec2 id;
layout(location = 0) out uvec2 seen;

void main() { seen = id; }
