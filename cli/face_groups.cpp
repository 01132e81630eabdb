// SPDX-License-Identifier: MIT
#include "cli/face_groups.h"

#include "cli/command/values.h"
#include "cli/csv_files.h"

namespace twinray::cli {

void FaceGroupOptions::set_groups(Faces& faces) const {
    if (by == FaceGrouping::custom) faces.set_custom_groups(read_face_groups(file, faces.count()));
}

std::vector<Option> face_group_options(FaceGroupOptions& options, const std::string& of_what,
                                       const std::vector<std::string>& needs) {
    Names<FaceGrouping> groupings;
    for (const FaceGrouping by :
         {FaceGrouping::face, FaceGrouping::mesh, FaceGrouping::instance, FaceGrouping::material})
        groupings.emplace_back(name_of(by), by);
    Value groups = cli::file(options.file);
    groups.store = [store = groups.store, &options](std::span<const std::string> words) {
        options.by = FaceGrouping::custom;
        return store(words);
    };
    return {{.name = "--by",
             .value = choice(options.by, groupings),
             .help = of_what + " per face, mesh, instance or material",
             .needs = needs},
            {.name = "--groups",
             .value = groups,
             .help = of_what +
                     " per group in a CSV file of face,group, which lists each face once; groups are numbered from 0",
             .needs = needs,
             .excludes = {"--by"}}};
}

}  // namespace twinray::cli
