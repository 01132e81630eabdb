// SPDX-License-Identifier: MIT
#include "samples/path_tracer/merge.h"

#include <cstdio>

#include "renderer/film_file.h"
#include "samples/path_tracer/report.h"

namespace twinray::path_tracer {
namespace {

Film merged(const std::vector<std::filesystem::path>& files) {
    Film film = load_film(files[0]);
    for (std::size_t i = 1; i < files.size(); ++i)
        film.merge(load_film(files[i]), files[0].string() + (i > 1 ? " and others" : ""), files[i].string());
    return film;
}

}  // namespace

int merge_films(const MergeOptions& options) {
    check_folder(options.output);
    const Film film = merged(options.films);
    if (is_film_file(options.output))
        save_film(options.output, film);
    else
        write_picture_of(options.output, film, options.exposure);
    report_merge(options, film);
    return 0;
}

}  // namespace twinray::path_tracer
