// SPDX-License-Identifier: MIT
struct Face
{
    uint instance;
    uint primitive;
};
