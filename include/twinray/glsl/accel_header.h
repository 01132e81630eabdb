// SPDX-License-Identifier: MIT
// The header at address AccelView::scene, which both accelerators share.
#ifndef TWINRAY_ACCEL_HEADER_H
#define TWINRAY_ACCEL_HEADER_H

// The addresses of data that only some accelerators keep.
struct AccelHeader {
    Address surfaces;    // of a SurfaceTable, absent without AccelOptions::keeps_surfaces
    Address refinement;  // of a RefineScene, absent below Level::refined
};
BUFFER_OF(AccelHeader, 8);
#endif
