// Files of the viewer: the list of those that were shown last, and a layer's values of faces.
#pragma once

#include <filesystem>
#include <vector>

#include "viewer/layers.h"

namespace twinray::viewer {

// Returns the file that keeps them: twinray/recent in $XDG_STATE_HOME, else in .local/state of $HOME; empty: none.
std::filesystem::path recent_list();
// Returns the files of the list, the last one first, at most eight; leaves out files that are gone.
std::vector<std::filesystem::path> recent_files(const std::filesystem::path& list);
// Puts a file first. If it cannot write the list, it keeps nothing and reports no error.
void keep_recent(const std::filesystem::path& list, const std::filesystem::path& file);

// .csv: instance, triangle and value of each face that has one; .glb: the scene with its faces in the values' colours.
// Throws Error if values are not those of faces, and naming the file if it cannot be written.
void write_values(const std::filesystem::path& file, const Scene& scene, const Values& values);

}  // namespace twinray::viewer
