// SPDX-License-Identifier: MIT
// `twinray collide`: which triangles of a scene touch or intersect, or which boxes of instances overlap.
#include <chrono>
#include <fstream>
#include <iostream>

#include "cli/collide_picture.h"
#include "cli/places.h"
#include "engine/accel/scene_push.h"
#include "engine/core/error.h"

namespace twinray::cli {
namespace {

struct CollideOptions {
    CommonOptions common;
    std::filesystem::path scene, output;
    std::string accel = "sw";
    bool is_broad = false;
    ContactOptions contacts;
    std::uint64_t max_pairs = PairSearch::default_max_pairs;
    PictureOptions pictures;
};

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// CSV, a line for each row as `print` writes it.
template <class Row, class Print>
void write_table(const std::filesystem::path& file, const char* header, const std::vector<Row>& rows,
                 const Print& print) {
    if (file.empty()) return;
    std::ofstream out(file);
    out << header << '\n';
    for (const Row& row : rows) print(out, row);
    if (!out.flush()) fail("CSV file '", file.string(), "' cannot be written");
}

std::unique_ptr<AbstractAccel> filled_accel(const CollideOptions& options, Context& context, const Scene& scene) {
    std::unique_ptr<AbstractAccel> accel = make_accel(context, options.accel);
    push_scene(*accel, scene);
    context.wait(accel->sync());
    return accel;
}

// The title goes onto the picture here.
void draw(const CollideOptions& options, AbstractAccel& accel, const Scene& scene, ScenePicture picture,
          const std::string& found) {
    picture.page.title = options.scene.filename().string() + ": collisions";
    picture.page.subtitle = found;
    write_pictures(options.pictures, accel, scene, picture);
}

void run_broad(const CollideOptions& options) {
    const Scene scene = load_scene_with_warnings(options.scene, options.common.quiet);
    const std::unique_ptr<Context> context = make_context(options.common);
    const std::unique_ptr<AbstractAccel> accel = filled_accel(options, *context, scene);
    CollisionFinder finder(*context);
    finder.set_max_pairs(options.max_pairs);
    const Clock::time_point start = Clock::now();
    const std::vector<InstancePair> pairs = finder.instance_pairs(*accel);
    const double seconds = seconds_since(start);
    write_table(options.output, "instance_a,instance_b", pairs,
                [](std::ostream& out, const InstancePair& pair) { out << pair.a << ',' << pair.b << '\n'; });
    if (!options.pictures.files.empty())
        draw(options, *accel, scene, picture_of_pairs(options.pictures, scene, pairs),
             text(pairs.size(), " pairs of boxes overlap"));
    if (!options.common.quiet)
        std::cout << scene.instances.size() << " instances, " << pairs.size() << " pairs of boxes overlap, " << seconds
                  << " s with copies\n";
    append_json(options.common.json, {{"schema", "twinray-collide/1"},
                                      {"device", describe(*context)},
                                      {"scene", options.scene.string()},
                                      {"origin", list_of(scene.origin)},
                                      {"phase", "broad"},
                                      {"backend", options.accel},
                                      {"instances", scene.instances.size()},
                                      {"pairs", pairs.size()},
                                      {"seconds", seconds}});
}

nlohmann::json counts_of(const Contacts& contacts) {
    nlohmann::json counts;
    for (const PairClass each : all_pair_classes)
        if (each != PairClass::separate) counts[std::string(name_of(each))] = contacts.count(each);
    return counts;
}

void print(const Scene& scene, const Contacts& contacts, const nlohmann::json& counts) {
    std::cout << scene.instances.size() << " instances, " << contacts.instances << " of them with "
              << contacts.triangles << " triangles may touch\n"
              << contacts.candidates << " pairs of triangles' boxes overlap, " << contacts.search_seconds << " s\n"
              << contacts.list.size() << " pairs touch or intersect, " << contacts.classify_seconds << " s, "
              << contacts.host_seconds << " s of them for " << contacts.host_decided
              << " that float64 could not decide\n";
    for (const auto& [name, count] : counts.items()) std::cout << "    " << name << ' ' << count << '\n';
}

void run_exact(const CollideOptions& options) {
    const Scene scene = load_scene_with_warnings(options.scene, options.common.quiet);
    const std::unique_ptr<Context> context = make_context(options.common);
    ContactFinder finder(*context);
    finder.set_max_pairs(options.max_pairs);
    ContactOptions wanted = options.contacts;
    wanted.segments = !options.pictures.files.empty();
    const Contacts contacts = finder.find(scene, wanted);
    write_table(options.output, "instance_a,instance_b,triangle_a,triangle_b,class", contacts.list,
                [](std::ostream& out, const TriangleContact& c) {
                    out << c.instance_a << ',' << c.instance_b << ',' << c.triangle_a << ',' << c.triangle_b << ','
                        << name_of(c.pair_class) << '\n';
                });
    if (!options.pictures.files.empty())
        draw(options, *filled_accel(options, *context, scene), scene, picture_of_contacts(scene, contacts),
             text(contacts.list.size(), " pairs of triangles touch or intersect"));
    const nlohmann::json counts = counts_of(contacts);
    if (!options.common.quiet) print(scene, contacts, counts);
    append_json(options.common.json, {{"schema", "twinray-collide/1"},
                                      {"device", describe(*context)},
                                      {"scene", options.scene.string()},
                                      {"origin", list_of(scene.origin)},
                                      {"phase", "exact"},
                                      {"self", options.contacts.self},
                                      {"weld", options.contacts.shared == Shared::by_position},
                                      {"instances", scene.instances.size()},
                                      {"instances_near", contacts.instances},
                                      {"triangles", contacts.triangles},
                                      {"candidates", contacts.candidates},
                                      {"contacts", contacts.list.size()},
                                      {"classes", counts},
                                      {"host_decided", contacts.host_decided},
                                      {"search_seconds", contacts.search_seconds},
                                      {"classify_seconds", contacts.classify_seconds},
                                      {"host_seconds", contacts.host_seconds}});
}

void run(const CollideOptions& options) {
    if (!options.output.empty()) check_writable(options.output);
    check_pictures(options.pictures);
    if (options.is_broad && options.contacts.self) fail("collide: --broad knows instances; --self is about triangles");
    if (options.is_broad)
        run_broad(options);
    else
        run_exact(options);
}

}  // namespace

void add_collide(CLI::App& app, int&) {
    CLI::App* command = app.add_subcommand("collide", "which instances and triangles of a scene touch or overlap");
    const auto options = std::make_shared<CollideOptions>();
    command->add_option("scene", options->scene, ".gltf, .glb, .obj, .ply or .stl")->required();
    command->add_flag("--broad", options->is_broad, "pairs of instances whose boxes overlap, instead of triangles");
    command->add_option("-o,--output", options->output, "written: the pairs as CSV");
    command
        ->add_option("--accel", options->accel,
                     "whose boxes --broad takes, and what pictures are traced with; answers are the same")
        ->check(CLI::IsMember({"sw", "hw"}))
        ->capture_default_str();
    command->add_flag("--self", options->contacts.self,
                      "also pairs within an instance, but for neighbours that only share vertices");
    command->add_flag_callback(
        "--weld", [options] { options->contacts.shared = Shared::by_position; },
        "with --self: vertices at one position are one, as where faces have normals of their own");
    command->add_option("--max-pairs", options->max_pairs, "of boxes that overlap: 17 bytes of device memory each")
        ->check(CLI::Range(std::uint64_t{1}, PairSearch::most_pairs))
        ->capture_default_str();
    add_picture_options(*command, options->pictures,
                        "the worst contact of each face, or with --broad how many boxes that of its instance overlaps");
    add_common_options(*command, options->common);
    command->callback([options] { run(*options); });
}

}  // namespace twinray::cli
