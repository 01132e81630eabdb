// Files of films: checkpoints, shards, and their merged films.
#pragma once

#include <filesystem>

#include "renderer/film.h"

namespace twinray::path_tracer {

// Writes the whole film or nothing: an existing file is replaced at the end. Little endian: "twinray film 1\n" and a
// zero byte; six uint32: width, height, block size, bytes of the text, words of the block set, CRC-32 of the text; the
// text, one "name: value" a line; the block set; the pixels, row by row, as FilmPixel in shaders/path_tracer/film.h;
// CRC-32 of all before it.
void save_film(const std::filesystem::path& file, const Film& film);

// Throws Error naming the file if it is no film, damaged or cut short.
Film load_film(const std::filesystem::path& file);

bool is_film_file(const std::filesystem::path& file);

}  // namespace twinray::path_tracer
