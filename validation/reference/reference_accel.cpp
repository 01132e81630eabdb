#include "engine/accel/trace_desc.h"
#include "validation/reference/reference_accel.h"

#include <map>

#include "engine/accel/accel_backend.h"
#include "engine/core/error.h"
#include "engine/core/parallel.h"
#include "verify_copy_items.spv.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/shared/copies.h"
#include "twinray/glsl/cpp_end.h"

namespace {

// Returns the box in units of the geometry's scale; it is exact, as vertices are float32.
GeometryBox box_of(const Geometry& geometry, const Geometry64& triangles) {
    Bounds box{vec3(triangles.bounds().corners[0]), vec3(triangles.bounds().corners[1])};
    for (const Bounds& each : geometry.boxes) box.include(each);
    return {box.lo / geometry.scale, box.hi / geometry.scale};
}

Hit hit_of(const ReferenceHit& found, const Ray& ray) {
    const std::optional<float> t = found.hit ? reported_t(found.t, ray) : std::nullopt;
    if (!t) return miss();
    return {1,
            *t,
            found.primitive,
            found.custom_index,
            float(found.u),
            float(found.v),
            found.instance,
            found.is_front ? HIT_FRONT : 0};
}

// Hides an instance whose transform kernels have made unusable, as accelerators do.
ReferenceInstance placed(const InstanceRecord& record, uint geometry) {
    ReferenceInstance instance{geometry, transform_of(record), options_of(record)};
    if (fault_of(instance.object_to_world).empty()) return instance;
    instance.object_to_world = {};
    instance.options.mask = 0;
    return instance;
}

}  // namespace

std::optional<float> reported_t(double t, const Ray& ray) {
    const float least = std::nextafter(std::max(0.0f, ray.t_min), INFINITY);
    const float most = std::nextafter(ray.t_max, 0.0f);
    if (least > most || t > std::numeric_limits<float>::max()) return std::nullopt;
    return std::clamp(float(t), least, most);
}

class ReferenceBackend final : public AccelBackend {
  public:
    explicit ReferenceBackend(Context& context)
        : AccelBackend(context, "ReferenceAccel"),
          copy_items_(context, {.name = "verify_copy_items", .spirv = verify_copy_items_spirv}) {}

    Capability capability(Feature feature) const override {
        switch (feature) {
            case Feature::boxes:
            case Feature::filters: return {feature, Support::unsupported, "the host runs no GPU code"};
            case Feature::kernel_queries:
            case Feature::save_and_load: return {feature, Support::unsupported, "nothing is built on the device"};
            case Feature::refit_vertices: return {feature, Support::emulated, "from the host, by building anew"};
            case Feature::level_fast:
            case Feature::level_watertight:
            case Feature::level_refined:
            case Feature::level_certified: return {feature, Support::native, "float64, whatever the level"};
            default: return {feature, Support::native, ""};
        }
    }

    bool is_software() const override { return true; }

  private:
    struct ReferenceGeometry : BuiltGeometry {
        std::shared_ptr<const Geometry64> geometry;
    };

    // The results of the last sync: the instance records, once its commands have run, and the blocks they may point at.
    struct ReferenceState : BuiltTlas {
        Buffer records;
        std::map<std::uint64_t, std::shared_ptr<const Geometry64>> geometries;  // by the address of their block
        uint count = 0;
    };

    // The closest hit is one of those that Query::any may find.
    class ReferenceProgram final : public TraceProgram {
      public:
        explicit ReferenceProgram(const ReferenceBackend& accel)
            : TraceProgram(accel.id(), 0, "reference"), accel_(accel) {}
        void prepare(Query, Level) const override {}
        void record(Commands& commands, const TraceArgs& args, Query, Level) const override {
            accel_.record_trace(commands, args);
        }

      private:
        const ReferenceBackend& accel_;
    };

    std::vector<std::unique_ptr<AccelBackend::BuiltGeometry>> build_geometries(
        Commands& commands, std::span<const GeometryInput> inputs) override {
        if (inputs.empty()) return {};
        std::vector<std::unique_ptr<BuiltGeometry>> built;
        const auto pass = commands.pass("reference geometry blocks");
        for (const GeometryInput& input : inputs) {
            auto made = std::make_unique<ReferenceGeometry>();
            made->geometry = std::make_shared<const Geometry64>(
                MeshView(input.geometry->name, input.geometry->positions, input.geometry->triangles));
            commands.write(*input.block, box_of(*input.geometry, *made->geometry));
            geometries_[input.block->address()] = made->geometry;
            built.push_back(std::move(made));
        }
        return built;
    }

    // The host's vertices are the latest: those in device memory are refused.
    std::vector<std::unique_ptr<AccelBackend::BuiltGeometry>> refit_geometries(
        Commands& commands, std::span<const GeometryInput> inputs) override {
        return build_geometries(commands, inputs);
    }

    BuildBytes geometry_bytes(std::span<const GeometrySize>) const override { return {}; }

    BuildBytes scene_bytes(std::size_t count, std::size_t) const override {
        return {std::max<std::size_t>(count, 1) * sizeof(InstanceRecord), 0};
    }

    bool works_on_device() const override { return false; }

    std::unique_ptr<AccelBackend::BuiltTlas> build_tlas(Commands& commands, const TlasInput& input,
                                                        const BuiltTlas*) override {
        auto made = std::make_unique<ReferenceState>();
        made->count = input.count;
        made->bytes = std::max(input.count, 1u) * sizeof(InstanceRecord);
        made->records =
            Buffer(context(), {.name = "reference records", .bytes = made->bytes, .memory = Memory::readback});
        std::erase_if(geometries_, [](const auto& named) { return named.second.expired(); });
        for (const auto& [block, geometry] : geometries_) made->geometries.emplace(block, geometry.lock());
        refit_tlas(commands, input, *made);
        return made;
    }

    void refit_tlas(Commands& commands, const TlasInput& input, const BuiltTlas& current) override {
        if (input.count)
            record_copy(commands, input.records,
                        static_cast<const ReferenceState&>(current).records.ref<InstanceRecord>(), input.count);
    }

    void measure_tlas(Commands&, const TlasInput&, const BuiltTlas&) const override {}  // it has no trees

    std::unique_ptr<TraceProgram> create_program(const TraceProgramCode* code, uint) const override {
        if (code)
            fail(name(), ": program '", code->name, "': the host runs no GPU code; boxes and filters are unsupported");
        return std::make_unique<ReferenceProgram>(*this);
    }

    // The rays go ahead of the commands of the trace: host memory needs none.
    std::vector<Hit> trace_host(std::span<const Ray> rays, TraceDesc desc) override {
        sync();
        if (rays.empty()) return {};
        const Buffer input(context(), {.name = "rays", .bytes = rays.size_bytes(), .memory = Memory::upload});
        const Buffer hits(context(), {.name = "hits", .bytes = rays.size() * sizeof(Hit)});
        std::memcpy(input.mapped(), rays.data(), rays.size_bytes());
        desc.rays = input.ref<Ray>();
        desc.hits = hits.ref<Hit>();
        desc.count = rays.size();
        Commands commands(context(), "reference trace");
        trace(commands, view(), desc);
        commands.submit();
        return download<Hit>(context(), hits, rays.size());
    }

    template <class T>
    void record_copy(Commands& commands, Ref<T> from, Ref<T> to, std::size_t count) const {
        copy_items_.dispatch(commands,
                             {{from.address}, {to.address}, static_cast<uint>(count), sizeof(T) / sizeof(uint)}, count);
    }

    // Returns the contents there after all work that has been submitted to the queue.
    template <class T>
    Buffer read(Ref<T> from, std::size_t count) const {
        Buffer buffer(context(), {.name = "reference input", .bytes = count * sizeof(T), .memory = Memory::readback});
        Commands commands(context(), "reference input");
        record_copy(commands, from, buffer.ref<T>(), count);
        context().wait(commands.submit());
        return buffer;
    }

    // Returns the scene as the last sync, which must be done, has left it.
    ReferenceScene synced_scene() const {
        const auto& scene = static_cast<const ReferenceState&>(built_tlas());
        std::vector<InstanceRecord> records(scene.count);
        if (scene.count) std::memcpy(records.data(), scene.records.mapped(), scene.count * sizeof(InstanceRecord));
        std::vector<std::shared_ptr<const Geometry64>> geometries;
        std::map<std::uint64_t, uint> index_of;
        for (const auto& [block, geometry] : scene.geometries) {
            index_of.emplace(block, static_cast<uint>(geometries.size()));
            geometries.push_back(geometry);
        }
        std::vector<ReferenceInstance> instances;
        for (const InstanceRecord& record : records) {
            const auto geometry = index_of.find(std::uint64_t{record.geometry});
            if (geometry == index_of.end())
                fail(name(), ": instance ", instances.size(), ": a kernel has written its geometry's address");
            instances.push_back(placed(record, geometry->second));
        }
        return {std::move(geometries), instances};
    }

    void record_trace(Commands& commands, const TraceArgs& args) const {
        std::size_t count = args.count;
        if (args.indirect_count.address) {
            const Buffer written = read(args.indirect_count, 1);
            count = std::min<std::size_t>(count, *reinterpret_cast<const uint*>(written.mapped()));
        }
        if (count == 0) return;
        const Buffer input = read(args.rays, count);
        if (!is_sync_done())
            fail(name(), ": trace: the last sync is not submitted yet; the host answers while it records");
        Buffer hits(context(), {.name = "reference hits", .bytes = count * sizeof(Hit), .memory = Memory::upload});
        const Ray* const rays = reinterpret_cast<const Ray*>(input.mapped());
        Hit* const found = reinterpret_cast<Hit*>(hits.mapped());
        const ReferenceScene reference = synced_scene();
        const ReferenceQuery query{static_cast<std::uint8_t>(args.mask), args.flags};
        parallel_for(count, [&](std::size_t i) { found[i] = hit_of(reference.closest_hit(rays[i], query), rays[i]); });
        record_copy(commands, hits.ref<Hit>(), args.hits, count);
        commands.retain(std::move(hits));
    }

    Kernel<CopyItemsArgs> copy_items_;
    // The keys are addresses of the blocks that instances point at; an entry ends with the geometry it names.
    std::map<std::uint64_t, std::weak_ptr<const Geometry64>> geometries_;
};

ReferenceAccel::ReferenceAccel(Context& context) : AbstractAccel(std::make_unique<ReferenceBackend>(context)) {}

}  // namespace twinray
