#include "cli/kernels/kernels.h"

#include <twinray/analysis.h>
#include <twinray/context.h>
#include <twinray/geometry.h>
#include <twinray/queries.h>
#include <twinray/scene.h>
#include <twinray/tlas.h>

#include <algorithm>
#include <mutex>

#include "engine/accel/trace_desc.h"
#include "engine/accel/ray_sort.h"
#include "engine/accel/surface_tables.h"
#include "engine/analysis/pair_sampler.h"
#include "engine/analysis/sky_rays.h"
#include "engine/core/error.h"
#include "engine/scene/rig.h"
#include "renderer/cross_check.h"
#include "renderer/renderer.h"
#include "renderer/scene_upload.h"
#include "renderer/shared.h"
#include "swtlas/tree.h"
#include "validation/reference/float_probe.h"
#include "validation/reference/reference_accel.h"

namespace twinray::kernels {
namespace {

// The names of variants.

using namespace path_tracer;

using Words = std::vector<std::string>;

struct Bit {
    uint bit;
    const char* word;
};

void add_features(Words& words, uint features) {
    constexpr Bit bits[] = {
        {FEATURE_COMPRESSED, "compressed4"},
        {FEATURE_COMPRESSED8, "compressed8"},
        {FEATURE_BVH2, "bvh2"},
        {FEATURE_INSTANCES, "instances"},
        {FEATURE_MASKS, "masks"},
        {FEATURE_CULLING, "culling"},
        {FEATURE_TRANSFORMS, "transforms"},
        {FEATURE_BOXES, "boxes"},
        {FEATURE_FILTERS, "filters"},
        {FEATURE_REMAP, "reordered"},
        {FEATURE_HITS, "hits"},
    };
    if (features == FEATURES_ALL) return void(words.emplace_back("everything"));
    if (features == (FEATURES_ALL & ~FEATURE_BOXES)) return void(words.emplace_back("everything but boxes"));
    for (const Bit& bit : bits)
        if (features & bit.bit) words.emplace_back(bit.word);
}

bool asks_rays(const KernelDesc& desc) {
    return std::ranges::find(desc.constants, FEATURES_CONSTANT, &SpecializationConstant::id) != desc.constants.end();
}

void add_of_rays(Words& words, const SpecializationConstant& constant) {
    if (constant.id == FEATURES_CONSTANT) add_features(words, constant.value);
    if (constant.id == LEVEL_CONSTANT) words.emplace_back(name_of(static_cast<Level>(constant.value)));
}

void add_of_path_tracer(Words& words, const KernelDesc& desc) {
    constexpr Bit bits[] = {
        {PT_HAS_ALPHA, "alpha"},
        {PT_HAS_TEXTURES, "textures"},
        {PT_HAS_GLASS, "glass"},
        {PT_HAS_SPECULAR, "specular"},
        {PT_HAS_COAT, "coat"},
        {PT_HAS_SHEEN, "sheen"},
        {PT_HAS_ANISOTROPY, "anisotropy"},
        {PT_HAS_VOLUME, "volume"},
        {PT_HAS_MEDIA, "media"},
        {PT_HAS_COLORS, "colors"},
        {PT_HAS_SECOND_UVS, "second-uvs"},
        {PT_HAS_PANES, "panes"},
        {PT_HAS_LOCAL_LIGHTS, "lights"},
        {PT_HAS_LIGHT_TREE, "light-tree"},
        {PT_HAS_ENVIRONMENT, "environment"},
    };
    uint chosen = 0;
    for (const SpecializationConstant& constant : desc.constants)
        if (constant.value == 1 && constant.id < 32) chosen |= 1u << constant.id;
    const bool is_all = std::ranges::all_of(bits, [&](const Bit& bit) { return chosen >> bit.bit & 1; });
    if (is_all) words.emplace_back("everything");
    for (const Bit& bit : bits)
        if (!is_all && chosen >> bit.bit & 1) words.emplace_back(bit.word);
    if (std::ranges::any_of(desc.constants, [](const SpecializationConstant& constant) {
            return constant.id == TEXEL_FORMATS_CONSTANT && constant.value == 1;
        }))
        words.emplace_back("deep-textures");
    if (chosen >> PT_HAS_AOVS & 1) words.emplace_back("aovs");
    if (chosen >> PT_HAS_QUEUES & 1) words.emplace_back("queues");
}

// A constant that chooses among words, of the kernels whose names begin so.
struct Choice {
    std::string_view kernels;
    uint id;
    const char* words[2];
};

void add_of_stage(Words& words, std::string_view kernel, const SpecializationConstant& constant) {
    constexpr Choice choices[] = {{"swtlas_hierarchy", 0, {"fast", "high"}},
                                  {"swtlas_collapse", 0, {"roots", "level"}},
                                  {"sort_scatter", 3, {"values", "places"}}};
    if (kernel.starts_with("swtlas_") && constant.id == NODE_WIDTH_CONSTANT && constant.value == 8)
        words.emplace_back(name_of(Layout::compressed8));
    for (const Choice& choice : choices)
        if (kernel == choice.kernels && constant.id == choice.id && constant.value < 2)
            words.emplace_back(choice.words[constant.value]);
}

}  // namespace

std::string variant_of(const KernelDesc& desc) {
    Words words;
    if (desc.name.starts_with("path_tracer_")) {
        add_of_path_tracer(words, desc);
        return joined(words, " ");
    }
    const bool has_rays = asks_rays(desc);
    for (const SpecializationConstant& constant : desc.constants) {
        if (has_rays)
            add_of_rays(words, constant);
        else
            add_of_stage(words, desc.name, constant);
    }
    return joined(words, " ");
}

namespace {

bool is_same(const ListedKernel& a, const ListedKernel& b) {
    const auto same = [](const SpecializationConstant& x, const SpecializationConstant& y) {
        return x.id == y.id && x.value == y.value;
    };
    return a.desc.spirv.data() == b.desc.spirv.data() && a.args_bytes == b.args_bytes &&
           std::ranges::equal(a.desc.constants, b.desc.constants, same);
}

class Collector {
  public:
    void add(const KernelDesc& desc, std::uint32_t args_bytes) {
        ListedKernel kernel{desc.name, variant_of(desc), desc, args_bytes};
        const std::lock_guard lock(mutex_);
        if (has([&](const ListedKernel& other) { return is_same(kernel, other); })) return;
        const auto is_taken = [&](const ListedKernel& other) {
            return other.name == kernel.name && other.variant == kernel.variant;
        };
        for (int number = 2; has(is_taken); ++number) kernel.variant = variant_of(desc) + " #" + std::to_string(number);
        kernels_.push_back(std::move(kernel));
    }
    std::vector<ListedKernel> kernels() const {
        const std::lock_guard lock(mutex_);
        return kernels_;
    }

  private:
    template <class Predicate>
    bool has(const Predicate& predicate) const {
        return std::ranges::any_of(kernels_, predicate);
    }

    mutable std::mutex mutex_;
    std::vector<ListedKernel> kernels_;
};

// Adds the kernels of a host that specialises a kernel or a program of its own for no scene.
void add_unspecialized(Collector& collector) {
    for (ListedKernel& kernel : collector.kernels()) {
        const auto features = std::ranges::find(kernel.desc.constants, FEATURES_CONSTANT, &SpecializationConstant::id);
        if (features == kernel.desc.constants.end()) continue;
        features->value = FEATURES_ALL;
        collector.add(kernel.desc, kernel.args_bytes);
    }
}

// The kernels with which both accelerators trace: one mesh, several meshes, and a scene with all features.

enum class Stage : std::uint8_t { one_mesh, instances, everything };
constexpr Stage all_stages[] = {Stage::one_mesh, Stage::instances, Stage::everything};

AccelOptions options_for(const DeviceProperties& device, Layout layout, Stage stage) {
    return {.level = device.shader_float64 ? Level::certified : Level::watertight,
            .layout = layout,
            .can_move = stage == Stage::everything,
            .compiles_in_background = false};
}

void fill(AbstractAccel& accel, Stage stage) {
    const Mesh mesh = make_quad(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0));
    const std::vector<Transform> transforms(stage == Stage::one_mesh ? 1 : 2);
    std::vector<InstanceOptions> options(transforms.size());
    if (stage == Stage::everything) options.front().mask = 1;
    accel.push(mesh, transforms, options);
}

void trace(AbstractAccel& accel, TraceDesc desc) {
    Context& context = accel.context();
    const Buffer rays(context, {.name = "rays", .bytes = sizeof(Ray)});
    const Buffer hits(context, {.name = "hits", .bytes = sizeof(Hit)});
    desc.rays = rays.ref<Ray>();
    desc.hits = hits.ref<Hit>();
    desc.count = 1;
    Commands commands(context, "trace");
    accel.trace(commands, accel.view(), desc);
    commands.submit();
}

// Traces each query at each level. Levels that need float64 do more with a hit and the same with the scene, so the
// largest scene is enough.
void trace_all(AbstractAccel& accel, Stage stage) {
    fill(accel, stage);
    accel.sync();
    for (const Level level : all_levels) {
        const Feature feature = feature_of(level);
        if (level > Level::watertight && stage != Stage::everything) continue;
        if (level > accel.options().level || accel.capability(feature).support == Support::unsupported) continue;
        for (const Query query : {Query::closest, Query::any})
            trace(accel, {.query = query,
                          .mask = static_cast<std::uint8_t>(stage == Stage::everything ? 2 : 0xff),
                          .cull = stage == Stage::everything ? Cull::back : Cull::none,
                          .level = level,
                          .occlusion_only = query == Query::any});
    }
}

void make_trace_kernels(Context& context) {
    const DeviceProperties& device = context.properties();
    for (const Layout layout : all_layouts)
        for (const Stage stage : all_stages) {
            SwTlas accel(context, options_for(device, layout, stage));
            trace_all(accel, stage);
        }
    if (!missing_for_hardware(device).empty()) return;
    for (const BuildOrder order : {BuildOrder::input, BuildOrder::morton}) {
        AccelOptions options = options_for(device, Layout::compressed4, Stage::everything);
        options.level = std::min(options.level, Level::refined);
        HwTlas accel(context, order, options);
        trace_all(accel, Stage::everything);
    }
}

// All other kernels: builds, sorts, and what the other libraries compute. Each is created, or used once if that creates
// the kernel.

AccelOptions options_for(const DeviceProperties& device, Layout layout, BuildQuality quality) {
    return {.level = device.shader_float64 ? Level::refined : Level::watertight,
            .layout = layout,
            .build_quality = quality};
}

// Makes the first such mesh, which compiles its kernels.
void make_device_mesh(Context& context) {
    SwTlas accel(context, {.keeps_surfaces = true, .compiles_in_background = false});
    const Buffer zeros(context, {.name = "zeros", .bytes = 64});
    const DeviceAttribute heat{"heat", 1, false, zeros.ref<float>()};
    accel.push(DeviceMesh{.name = "point",
                          .positions = zeros.address(),
                          .vertex_count = 1,
                          .indices = zeros.address(),
                          .triangle_count = 1,
                          .attributes = {&heat, 1}});
    accel.sync();
}

void make_builds(Context& context) {
    for (const BuildQuality quality : all_build_qualities)
        for (const Layout layout : all_layouts) {
            SwTlas accel(context, options_for(context.properties(), layout, quality));
            accel.push(make_box(vec3(0), vec3(1)));
            accel.sync();
        }
    const RaySort sort(context);
    const ReferenceAccel reference(context);
    const SurfaceKernels surfaces(context);
    make_device_mesh(context);
    if (missing_for_hardware(context.properties()).empty()) {
        const AccelOptions options = options_for(context.properties(), Layout::compressed4, BuildQuality::fast);
        const HwTlas accel(context, BuildOrder::morton, options);
    }
}

void make_queries(AbstractAccel& accel) {
    if (accel.capability(Feature::kernel_queries).support != Support::unsupported) const AllHits hits(accel);
}

void make_analysis(Context& context) {
    const Scene scene = cornell_box_scene();
    SwTlas accel(context, {.compiles_in_background = false});
    push_scene(accel, scene);
    accel.sync();
    const Faces faces(context, scene);
    const ViewFactors factors(accel, faces, {});
    const PairSampler pairs(accel, faces, Sides::front, Sequence::sobol, 1);
    const SkyRays sky(accel, faces, {});
    illuminate(accel, faces, {.grid = {.side = 1}});
    const vec3 up(0, 1, 0);
    visibility(accel, std::span(&up, 1), std::span(&up, 1));
    const std::array<float, 4> heights = {};
    const vec2 way(1);
    horizon(accel.context(), {.heights = heights, .columns = 2, .rows = 2}, {.size = {1, 1}, .ways = {&way, 1}});
}

void make_library_kernels(Context& context) {
    make_builds(context);
    SwTlas software(context);
    make_queries(software);
    if (missing_for_hardware(context.properties()).empty()) {
        HwTlas hardware(context);
        make_queries(hardware);
    }
    const BroadPhase collisions(context);
    if (context.properties().shader_float64) {
        const NarrowPhase contacts(context);
        const PointQuery points(context);
    }
    const Deformer deformer(context, std::make_shared<Rig>());
    probe_floats(context);
    make_analysis(context);
}

// The kernels of the path tracer: those of a plain scene, and those with all features.

Scene plain_scene() {
    Scene scene = cornell_box_scene();
    for (Material& material : scene.materials) material.transmission = 0;
    return scene;
}

void make_path_tracer_kernels(Context& context) {
    namespace pt = path_tracer;
    Scene scene = plain_scene();
    const pt::LocalLights lights = pt::collect_lights(scene);
    const pt::EnvironmentMap sky(pt::default_sky());
    SwTlas accel(context, {.compiles_in_background = false});
    push_scene(accel, scene);
    accel.sync();
    const pt::RenderSettings settings{.width = 8, .height = 8};
    for (const pt::SceneFeatures& features : {pt::features_of(scene, lights, nullptr), pt::all_features(scene)}) {
        pt::DeviceScene on_device(context, scene, lights, &sky, features);
        pt::Renderer renderer(context, on_device, settings);
        renderer.first_surfaces(accel);
        const pt::CrossChecker checker(context, accel, renderer, renderer.film_size());
    }
}

}  // namespace

KernelList list_kernels(const ContextDesc& desc) {
    const auto collector = std::make_shared<Collector>();
    ContextDesc watched = desc;
    watched.watch_kernels = [collector](const KernelDesc& kernel, std::uint32_t args_bytes) {
        collector->add(kernel, args_bytes);
    };
    auto context = std::make_unique<Context>(watched);
    make_trace_kernels(*context);
    add_unspecialized(*collector);
    make_library_kernels(*context);
    make_path_tracer_kernels(*context);
    return {std::move(context), collector->kernels()};
}

}  // namespace twinray::kernels
