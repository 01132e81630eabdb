// SPDX-License-Identifier: MIT
// Names a face: faces are numbered by instance, then by triangle.
struct Face
{
    uint instance;
    uint primitive;
};
