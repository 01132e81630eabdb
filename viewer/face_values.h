// SPDX-License-Identifier: MIT
// What analyses say of each face.
#pragma once

#include "viewer/picture/marks.h"
#include "viewer/layers.h"
#include "viewer/stage.h"

namespace twinray::viewer {

// Towards the sun, of a day whose sun rises at 6 along +x and stands highest at 12; z is up where `up` says so.
dvec3 sun_at(double hour, UpAxis up);

// How much of what is turned to the sun is lit, from 0 to 1.
Values light_on(Stage& stage, double hour, UpAxis up);
// View factors from a face to all others.
Values factors_from(Stage& stage, std::size_t face);
// The worst class of contact, by its number in PairClass; and where triangles cross.
Values contacts_of(Stage& stage, std::vector<Stroke>& segments);

}  // namespace twinray::viewer
