// SPDX-License-Identifier: MIT
// What AccelView::scene is the address of, of either accelerator.
#ifndef TWINRAY_ACCEL_HEADER_H
#define TWINRAY_ACCEL_HEADER_H

// Where to find what only some accelerators keep.
struct AccelHeader {
    Address surfaces;    // of a SurfaceTable, absent without AccelOptions::keeps_surfaces
    Address refinement;  // of a RefineScene, absent below Level::refined
};
BUFFER_OF(AccelHeader, 8);
#endif
