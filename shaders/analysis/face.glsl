// SPDX-License-Identifier: MIT
// Which face: faces are numbered by instance, then by triangle.
struct Face
{
    uint instance;
    uint primitive;
};
