// SPDX-License-Identifier: MIT
#include "renderer/film_file.h"

#include <cstring>

#include "engine/scene/bytes.h"
#include "tests/fuzz/contract.h"

namespace twinray::fuzz {
namespace {

void load_film(Input bytes) {
    is_taken([&] {
        path_tracer::Film film = path_tracer::load_film(file_of(bytes, "input.film"));
        require(film.pixels.size() == std::size_t{film.width} * film.height, "a film has its pixels");
        film.mean();
        film.error();
        film.blocks.end();
        film.merge(path_tracer::Film::empty(film.width, film.height, film.block_size, film.configuration), "a", "b");
    });
}

}  // namespace

// As it is, and with the checksum at the end as it should be: a fuzzer does not guess it.
void film(Input input) {
    load_film(input);
    Bytes file(input.begin(), input.end());
    if (file.size() < sizeof(std::uint32_t)) return;
    const std::size_t body = file.size() - sizeof(std::uint32_t);
    const std::uint32_t sum = crc32_of(std::as_bytes(std::span(file)).first(body));
    std::memcpy(file.data() + body, &sum, sizeof sum);
    load_film(file);
}

}  // namespace twinray::fuzz
