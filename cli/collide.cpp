// `twinray collide`: which triangles of a scene touch or intersect, or which boxes of instances overlap.
#include <twinray/queries.h>

#include <array>

#include "cli/analysis_options.h"
#include "cli/csv_files.h"

namespace twinray::cli {
namespace {

struct CollideOptions : AnalysisOptions {
    bool is_broad = false;
    ContactOptions contacts;
    std::uint64_t max_pairs = default_max_pairs;
};

// One colour for each class, from the most harmless to the worst, which is also the order of the classes.
constexpr std::array<Rgb, all_pair_classes.size()> class_colors = {plain_color,         categorical::sky_blue,
                                                                   categorical::green,  categorical::yellow,
                                                                   categorical::purple, categorical::vermilion};

Rgb color_of(PairClass pair_class) { return class_colors[static_cast<std::size_t>(pair_class)]; }

// Shows each face in the colour of its worst contact, and lines where crossing triangles meet.
ScenePicture picture_of_contacts(const Scene& scene, const Contacts& contacts) {
    const std::vector<std::size_t> first = first_faces(scene);
    std::vector<PairClass> worst(count_triangles(scene), PairClass::separate);
    for (const TriangleContact& contact : contacts.list)
        for (const std::size_t face :
             {first[contact.instance_a] + contact.triangle_a, first[contact.instance_b] + contact.triangle_b})
            worst[face] = std::max(worst[face], contact.pair_class);
    ScenePicture picture;
    std::ranges::transform(worst, std::back_inserter(picture.colors), color_of);
    for (std::size_t i = 0; i < contacts.segments.size(); ++i)
        if (contacts.list[i].pair_class == PairClass::crossing)
            picture.strokes.push_back({.from = contacts.segments[i].from, .to = contacts.segments[i].to});
    picture.page.legend.title = "worst contact";
    for (std::size_t i = all_pair_classes.size(); i-- > 0;) {
        const PairClass each = all_pair_classes[i];
        const bool is_none = each == PairClass::separate;
        picture.page.legend.entries.push_back({color_of(each), is_none ? "none" : std::string(name_of(each))});
    }
    if (!picture.strokes.empty()) picture.page.legend.entries.push_back({ink, "intersection"});
    return picture;
}

// Shows each instance in the colour of how many others its box overlaps.
ScenePicture picture_of_pairs(const PictureOptions& options, const Scene& scene,
                              const std::vector<InstancePair>& pairs) {
    std::vector<double> overlaps(scene.instances.size());
    for (const InstancePair& pair : pairs) ++overlaps[pair.a], ++overlaps[pair.b];
    std::vector<double> values;
    for (std::size_t i = 0; i < scene.instances.size(); ++i)
        values.insert(values.end(), scene.meshes[scene.instances[i].mesh].triangles.size(), overlaps[i]);
    return picture_of_values(options, values, "overlaps");
}

// Draws the picture with its title.
void draw(const CollideOptions& options, AbstractAccel& accel, const Scene& scene, ScenePicture picture,
          const std::string& found) {
    picture.page.title = options.scene.filename().string() + ": collisions";
    picture.page.subtitle = found;
    write_pictures(options.pictures, accel, scene, picture);
}

void run_broad(const CollideOptions& options) {
    const Analysed analysed(options);
    const auto& [scene, context, choice, accel] = analysed;
    BroadPhase broad_phase(*context);
    broad_phase.set_max_pairs(options.max_pairs);
    const Stopwatch start;
    const std::vector<InstancePair> pairs = broad_phase.instance_pairs(*accel);
    const double seconds = start.seconds();
    write_table(options.output, "instance_a,instance_b", pairs,
                [](std::ostream& out, const InstancePair& pair) { out << pair.a << ',' << pair.b << '\n'; });
    if (!options.pictures.files.empty())
        draw(options, *accel, scene, picture_of_pairs(options.pictures, scene, pairs),
             text(pairs.size(), " pairs of boxes overlap"));
    if (!options.common.quiet)
        std::cout << scene.instances.size() << " instances, " << pairs.size() << " pairs of boxes overlap, " << seconds
                  << " s with copies, " << text_of(choice) << '\n';
    nlohmann::json record = base_record("twinray-collide/1", *context, options.scene, scene);
    record.update(describe(choice));
    record.update(
        {{"phase", "broad"}, {"instances", scene.instances.size()}, {"pairs", pairs.size()}, {"seconds", seconds}});
    append_json(options.common.json, record);
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
    const Scene scene = load_scene(options.scene, options.common);
    const std::unique_ptr<Context> context = make_context(options.common);
    NarrowPhase narrow_phase(*context);
    narrow_phase.set_max_pairs(options.max_pairs);
    ContactOptions wanted = options.contacts;
    wanted.segments = !options.pictures.files.empty();
    const Contacts contacts = narrow_phase.find(scene, wanted);
    write_table(options.output, "instance_a,instance_b,triangle_a,triangle_b,class", contacts.list,
                [](std::ostream& out, const TriangleContact& c) {
                    out << c.instance_a << ',' << c.instance_b << ',' << c.triangle_a << ',' << c.triangle_b << ','
                        << name_of(c.pair_class) << '\n';
                });
    if (!options.pictures.files.empty())
        draw(options, *make_accel(*context, choose_accel(context->properties(), options.accel), scene), scene,
             picture_of_contacts(scene, contacts),
             text(contacts.list.size(), " pairs of triangles touch or intersect"));
    const nlohmann::json counts = counts_of(contacts);
    if (!options.common.quiet) print(scene, contacts, counts);
    nlohmann::json record = base_record("twinray-collide/1", *context, options.scene, scene);
    record.update({{"phase", "exact"},
                   {"self", options.contacts.self},
                   {"weld", options.contacts.shared == SharedVertices::by_position},
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
    append_json(options.common.json, record);
}

void run(const CollideOptions& options) {
    if (!options.output.empty()) check_writable(options.output);
    check_pictures(options.pictures);
    if (options.is_broad)
        run_broad(options);
    else
        run_exact(options);
}

}  // namespace

Command collide_command() {
    const auto options = std::make_shared<CollideOptions>();
    const Section pairs = {
        "Pairs",
        {{.name = "--broad",
          .value = flag(options->is_broad),
          .help = "find pairs of instances whose boxes overlap, instead of triangles"},
         {.name = "--self",
          .value = flag(options->contacts.self),
          .help = "also find pairs within an instance, except neighbours that only share vertices",
          .excludes = {"--broad"}},
         {.name = "--weld",
          .value = flag([options] { options->contacts.shared = SharedVertices::by_position; }),
          .help = "treat vertices at the same position as one, for meshes with separate normals per face",
          .needs = {"--self"}},
         {.name = "--max-pairs",
          .value = number(options->max_pairs, {1, std::uint64_t{UINT32_MAX}}),
          .help = "largest number of overlapping pairs of boxes; each takes 17 bytes of device memory"},
         output_option(
             file(options->output),
             "write the pairs as CSV: instance_a, instance_b and, without --broad, triangle_a, triangle_b, class"),
         accel_option(options->accel, "accelerator for --broad and for pictures, which does not change the results")}};
    return {.name = "collide",
            .group = "Analyses",
            .summary = "find triangles or instances of a scene that touch or overlap",
            .description =
                "Finds all pairs of triangles of different instances that touch or intersect, and classifies each "
                "pair: crossing, touching at a vertex or along an edge, coplanar. The classes are exact: if float64 "
                "cannot decide, arithmetic of higher precision does.",
            .positionals = {scene_argument(options->scene)},
            .sections =
                {pairs,
                 picture_options(
                     options->pictures,
                     "the worst contact of each face, or with --broad how many boxes the box of its instance overlaps"),
                 common_options(options->common)},
            .examples = {{"twinray collide machine.gltf -o pairs.csv", "the parts of a machine that collide"}},
            .run = done_after([options] { run(*options); })};
}

}  // namespace twinray::cli
