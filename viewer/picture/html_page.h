// SPDX-License-Identifier: MIT
// A picture as a page that tells what its points are: one file, without scripts.
#pragma once

#include <filesystem>
#include <span>

#include "viewer/picture/marks.h"
#include "viewer/picture/page.h"

namespace twinray {

// `whole`: `faces` composed with `page`. Each note with a detail is a spot that tells it where the pointer rests, and a
// row of a table below. Throws Error naming the file.
void write_html(const std::filesystem::path& file, const Raster& whole, const Page& page, const FacePicture& faces,
                std::span<const Note> notes);

}  // namespace twinray
