// `twinray trace`: a file of rays in, a file of hits out.
#include <charconv>
#include <map>

#include "cli/analysis_options.h"
#include "cli/shards.h"
#include "engine/scene/ray_file.h"
#include <twinray/queries.h>
#include "engine/core/files.h"
#include "viewer/picture/scene_picture.h"

namespace twinray::cli {
namespace {

struct TraceOptions {
    CommonOptions common;
    ShardOptions shards;
    std::filesystem::path scene, rays, hits, counts;
    std::string accel = "auto";
    std::string query = "closest";
    Level level = Level::watertight;
    Cull cull = Cull::none;
    uint mask = 0xff;
    std::vector<std::string> instance_masks;  // NAME=BITS each
    PictureOptions pictures;
    RayPictureDesc rays_shown;
};

using MasksByName = std::map<std::string, std::uint8_t, std::less<>>;

MasksByName read_masks(std::span<const std::string> words) {
    MasksByName masks;
    for (const std::string& word : words) {
        const std::size_t at = std::min(word.rfind('='), word.size());
        std::uint8_t bits = 0;
        const char* const last = word.data() + word.size();
        const auto [end, error] = std::from_chars(std::min(word.data() + at + 1, last), last, bits);
        if (at == 0 || error != std::errc() || end != last)
            throw UsageError(text("--instance-masks has '", word, "', but must be NAME=BITS, BITS from 0 to 255"));
        masks[word.substr(0, at)] = bits;
    }
    return masks;
}

void set_masks(AbstractAccel& accel, const Scene& scene, const MasksByName& masks) {
    for (const auto& [name, bits] : masks)
        if (std::ranges::find(scene.instances, name, &Instance::name) == scene.instances.end())
            fail("--instance-masks: the scene has no instance '", name, "'");
    auto instance = scene.instances.begin();
    for (const AccelHandle handle : accel.handles())
        for (std::size_t i = 0; i < accel.n_instances(handle); ++i, ++instance) {
            const auto found = masks.find(instance->name);
            if (found == masks.end()) continue;
            InstanceOptions changed = accel.get_instance(handle, i).options;
            changed.mask = found->second;
            accel.update_options(handle, i, changed);
        }
}

TraceDesc desc_of(const TraceOptions& options) {
    return {.mask = static_cast<std::uint8_t>(options.mask), .cull = options.cull, .level = options.level};
}

// The number of hits of each ray, and all hits, one after the other.
struct CountedHits {
    std::vector<std::uint32_t> counts;
    std::vector<Hit> hits;
};

CountedHits trace_all(AbstractAccel& accel, std::span<const Ray> rays, const TraceOptions& options) {
    HitsOfRays found = AllHits(accel)(rays, desc_of(options));
    std::vector<std::uint32_t> counts;
    for (std::size_t i = 0; i < rays.size(); ++i)
        counts.push_back(static_cast<std::uint32_t>(found.first[i + 1] - found.first[i]));
    return {std::move(counts), std::move(found.hits)};
}

std::vector<Hit> trace_in_batches(AbstractAccel& accel, std::span<const Ray> rays, const TraceOptions& options) {
    constexpr std::size_t batch_size = 1 << 20;
    std::vector<Hit> hits;
    hits.reserve(rays.size());
    samples::Progress progress("trace", rays.size(), options.common.quiet);
    for (std::size_t first = 0; first < rays.size(); first += batch_size) {
        const auto batch = rays.subspan(first, std::min(batch_size, rays.size() - first));
        const TraceDesc desc = desc_of(options);
        const std::vector<Hit> some =
            options.query == "any" ? accel.any_hits(batch, desc) : accel.closest_hits(batch, desc);
        hits.insert(hits.end(), some.begin(), some.end());
        progress.advance(batch.size());
    }
    return hits;
}

Agreement agreement_for(const TraceOptions& options, const Scene& scene, const AccelChoice& choice,
                        std::span<const Ray> rays) {
    std::string masks = std::to_string(options.mask);
    for (const std::string& mask : options.instance_masks) masks += ' ' + mask;
    return agreement_of("trace", scene, choice.name(),
                        {{"rays", checksum_text(std::as_bytes(rays))},
                         {"--query", options.query},
                         {"--level", std::string(name_of(options.level))},
                         {"--cull", std::to_string(static_cast<int>(options.cull))},
                         {"masks", masks}});
}

// Computes the hits of all rays; with --query all it writes their counts. Returns nothing if another process goes on.
std::optional<std::vector<Hit>> compute(const Shards& shards, const TraceOptions& options, const Agreement& agreement,
                                        AbstractAccel& accel, std::span<const Ray> rays) {
    const auto own = [&](Rows rows) { return rays.subspan(rows.first, rows.count()); };
    if (options.query != "all")
        return compute_rows<Hit>(shards, rays.size(), agreement,
                                 [&](Rows rows) { return trace_in_batches(accel, own(rows), options); });
    CountedHits all;
    if (shards.is_whole()) {
        all = trace_all(accel, rays, options);
    } else {
        const auto parts = shards.parts(rays.size(), agreement, [&](Rows rows) {
            const CountedHits found = trace_all(accel, own(rows), options);
            return joined<std::uint32_t, Hit>(found.counts, found.hits);
        });
        if (!parts) return {};
        for (std::size_t i = 0; i < parts->size(); ++i)
            split<std::uint32_t, Hit>((*parts)[i], shards.rows(static_cast<uint>(i), rays.size()).count(), all.counts,
                                      all.hits);
    }
    const std::span<const std::byte> piece = std::as_bytes(std::span(all.counts));
    write_file(options.counts, std::span(&piece, 1));
    return std::move(all.hits);
}

ScenePicture picture_of(const TraceOptions& options, const Scene& scene, std::span<const Ray> rays,
                        std::span<const Hit> hits) {
    ScenePicture picture = picture_of_rays(options.pictures, scene, rays, hits, options.rays_shown);
    picture.page.title = options.scene.filename().string() + ": rays";
    const auto found = std::ranges::count_if(hits, [](const Hit& hit) { return hit.hit != 0; });
    picture.page.subtitle = text(rays.size(), " rays, ", found, " hits");
    if (rays.size() > options.rays_shown.most_rays)
        picture.page.subtitle += text("; ", options.rays_shown.most_rays, " of them drawn");
    return picture;
}

void run(TraceOptions options) {
    const Shards shards(options.shards, options.common, options.hits);
    const bool is_all = options.query == "all";
    if (is_all == options.counts.empty())
        throw UsageError(is_all ? "--query all requires --counts, the number of hits of each ray"
                                : "--counts requires --query all");
    if (is_all && options.cull != Cull::none)
        throw UsageError("--query all finds hits of both sides and excludes --cull");
    if (is_all && options.level != Level::watertight) throw UsageError("--query all requires --level watertight");
    if (is_all && !options.pictures.files.empty())
        throw UsageError("--picture shows one hit per ray and excludes --query all");
    const MasksByName masks = read_masks(options.instance_masks);
    check_writable(options.hits);
    check_pictures(options.pictures);
    if (is_all) check_writable(options.counts);
    const Scene scene = load_scene(options.scene, options.common);
    const std::vector<Ray> rays = read_rays(options.rays, scene.origin);
    const std::unique_ptr<Context> context = make_context(options.common);
    const AccelChoice choice =
        choose_accel(context->properties(), options.accel, {.level = options.level, .kernel_queries = is_all});
    const std::unique_ptr<AbstractAccel> accel = make_accel(*context, choice, scene, options.level);
    set_masks(*accel, scene, masks);
    const Stopwatch start;
    const auto computed = compute(shards, options, agreement_for(options, scene, choice, rays), *accel, rays);
    if (!computed) return;
    const std::vector<Hit>& hits = *computed;
    const double seconds = start.seconds();
    write_hits(options.hits, hits);
    if (!options.pictures.files.empty())
        write_pictures(options.pictures, *accel, scene, picture_of(options, scene, rays, hits));
    const auto found = std::count_if(hits.begin(), hits.end(), [](const Hit& hit) { return hit.hit != 0; });
    if (!options.common.quiet)
        std::cout << rays.size() << " rays, " << found << " hits, " << seconds << " s with copies, " << text_of(choice)
                  << '\n';
    nlohmann::json record = base_record("twinray-trace/1", *context, options.scene, scene);
    record.update(describe(choice));
    record.update({{"level", name_of(options.level)},
                   {"query", options.query},
                   {"n", rays.size()},
                   {"hits", found},
                   {"seconds", seconds}});
    append_json(options.common.json, record);
}

}  // namespace

Command trace_command() {
    const auto options = std::make_shared<TraceOptions>();
    Section rays = {
        "Rays and hits",
        {{.name = "--rays",
          .value = file(options->rays),
          .help = "file of rays: 32 bytes each, little-endian: float32 origin (3), t_min, direction (3), t_max; or "
                  ".npy: N x 8 numbers in that order, float32 or float64; or .csv or .txt: x y z dx dy dz per line",
          .is_required = true},
         {.name = "--hits",
          .value = file(options->hits),
          .help = "write one hit per ray to this file: 32 bytes: uint32 hit, float32 t, uint32 primitive, custom "
                  "index, float32 u, v, uint32 instance, 0; a miss has t = -1; .npy: a NumPy array of such records; "
                  ".csv: one line per ray",
          .is_required = true},
         {.name = "--query",
          .value = choice(options->query, {"closest", "any", "all"}),
          .help = "closest: the hit with the smallest t; any: whether there is a hit; all: all hits in ascending order "
                  "of t"},
         {.name = "--counts",
          .value = file(options->counts),
          .help = "write the number of hits of each ray, as uint32, to this file; requires --query all"}}};
    const Names<Cull> sides = {{"none", Cull::none}, {"back", Cull::back}, {"front", Cull::front}};
    Section tracing = {
        "Tracing",
        {accel_option(options->accel),
         level_option(options->level),
         {.name = "--cull", .value = choice(options->cull, sides), .help = "do not hit triangles seen from this side"},
         {.name = "--mask",
          .value = number(options->mask, {0, 255}),
          .help = "mask of the rays, 8 bits: they hit instances whose mask has a bit in common with it"},
         {.name = "--instance-masks",
          .value = words(options->instance_masks, "NAME=BITS,..."),
          .help = "masks of instances, by their names in the scene; all other instances have 255"}}};
    const Names<HitColor> colors = {{"distance", HitColor::distance},
                                    {"instance", HitColor::instance},
                                    {"facing", HitColor::facing},
                                    {"normal", HitColor::normal}};
    const Section pictures = with(picture_options(options->pictures, "the hits"),
                                  {{.name = "--hit-color",
                                    .value = choice(options->rays_shown.color, colors),
                                    .help = "quantity that the colour of a hit shows",
                                    .needs = {"--picture"}},
                                   color_scale_option(options->pictures),
                                   {.name = "--labels",
                                    .value = flag(options->rays_shown.has_labels),
                                    .help = "print the number and distance of each hit beside it",
                                    .needs = {"--picture"}},
                                   {.name = "--most-rays",
                                    .value = number(options->rays_shown.most_rays, {1, 1'000'000}),
                                    .help = "largest number of rays to draw, chosen evenly",
                                    .needs = {"--picture"}}});
    return {.name = "trace",
            .group = "Tracing",
            .summary = "trace a file of rays",
            .description =
                "Reads a scene and a file of rays, traces the rays and writes a file of hits. t is in units of the "
                "ray's direction, which need not be normalised. Instances are numbered from 0 in the order of the "
                "scene's file, and primitives, the triangles of each mesh, likewise.",
            .positionals = {scene_argument(options->scene)},
            .sections = {rays, tracing, pictures, shard_options(options->shards, {"--picture"}, "--hits"),
                         common_options(options->common)},
            .examples = {{"twinray trace bunny.ply --rays rays.bin --hits hits.bin",
                          "closest hits of all rays, at a level that loses no ray at edges"}},
            .run = done_after([options] { run(*options); })};
}

}  // namespace twinray::cli
