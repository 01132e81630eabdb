// Histories of calls of AbstractAccel on ReferenceAccel, which shares everything but the trees with the others.
#include <algorithm>
#include <cmath>

#include "tests/fuzz/accel_model.h"
#include <twinray/context.h>
#include <twinray/validation.h>

namespace twinray::fuzz {
namespace {

bool is_usable(const ModelGeometry& geometry) {
    return std::ranges::all_of(geometry.boxes,
                               [](const Bounds& box) {
                                   const float sum = box.lo.x + box.lo.y + box.lo.z + box.hi.x + box.hi.y + box.hi.z;
                                   return !box.is_empty() && std::isfinite(sum);
                               }) &&
           std::ranges::all_of(geometry.mesh.triangles, [&](const uvec3& t) {
               return std::max({t.x, t.y, t.z}) < geometry.mesh.positions.size();
           });
}

Context& shared_context() {
    static Context context({.name = "twinray fuzz", .use_ray_query = false, .log = [](std::string_view) {}});
    static const std::unique_ptr<AbstractAccel> keeps_pipelines = make_reference_accel(context);
    return context;
}

// The accelerator and its model; each call changes both alike.
class History {
  public:
    explicit History(Arguments source) : source_(source) { begin(); }

    void run() {
        constexpr int most_calls = 64;
        for (int i = 0; i < most_calls && !source_.is_empty(); ++i) {
            call();
            model_.check(*accel_);
        }
    }

  private:
    void begin() {
        accel_ = make_reference_accel(shared_context());
        ++accel_count_;
        for (const ModelPlacing& placing : model_.placings) model_.dead.push_back(placing.handle);
        model_.placings.clear();
        model_.pending = Pending::structure;
        model_.revision = 0;
    }

    // Runs `change` on the model if the call must be taken.
    template <class Call, class Change = decltype([] {})>
    void expect(bool is_right, const std::string& name, const Call& call, const Change& change = {}) {
        require(is_taken(call) == is_right, name + (is_right ? " takes right use" : " refuses wrong use"));
        if (is_right) change();
    }

    AccelHandle any_handle() {
        const std::size_t i = source_.byte();
        const std::size_t dead = model_.dead.size() + 1;
        if (model_.placings.empty() || i % 8 == 7)
            return i / 8 % dead == 0 ? AccelHandle{} : model_.dead[i / 8 % dead - 1];
        return model_.placings[i % model_.placings.size()].handle;
    }

    void call() {
        switch (source_.below(16)) {
            case 0:
            case 1: return push();
            case 2: return push_instances_of();
            case 3: return append();
            case 4: return erase();
            case 5: return erase_instance();
            case 6: return update();
            case 7: return update_vertices();
            case 8: return update_transforms();
            case 9: return update_transform();
            case 10: return update_options();
            case 11: return sync();
            case 12: return look();
            case 13: return trace_view();
            case 14: return source_.below(8) == 0 ? begin() : ask_for_owners();
            default: return trace();
        }
    }

    static std::vector<InstanceState> states(std::span<const Transform> transforms,
                                             std::span<const InstanceOptions> options) {
        std::vector<InstanceState> all;
        for (std::size_t i = 0; i < transforms.size(); ++i)
            all.push_back({transforms[i], options.empty() ? InstanceOptions{} : options[i]});
        return all;
    }

    void push() {
        const ModelGeometry geometry = source_.geometry();
        const std::vector<Transform> transforms = source_.transforms(source_.below(4));
        const std::vector<InstanceOptions> options = source_.options(transforms.size());
        AccelHandle handle;
        expect(
            is_usable(geometry) && is_placeable(geometry.unit, transforms, options), "push",
            [&] {
                handle = geometry.has_boxes ? accel_->push(BoxesView{"boxes", geometry.boxes}, transforms, options)
                                            : accel_->push(geometry.mesh, transforms, options);
            },
            [&] { place(handle, std::make_shared<ModelGeometry>(geometry), states(transforms, options)); });
    }

    void place(AccelHandle handle, std::shared_ptr<ModelGeometry> geometry, std::vector<InstanceState> instances) {
        require(!model_.find(handle) && std::ranges::find(model_.dead, handle) == model_.dead.end(),
                "handles are never reused");
        model_.placings.push_back({handle, std::move(geometry), std::move(instances)});
        model_.mark(Pending::structure);
    }

    void push_instances_of() {
        const AccelHandle of = any_handle();
        const std::vector<Transform> transforms = source_.transforms(source_.below(3));
        const std::vector<InstanceOptions> options = source_.options(transforms.size());
        AccelHandle handle;
        expect(
            model_.find(of) && is_placeable(model_.find(of)->geometry->unit, transforms, options), "push_instances_of",
            [&] { handle = accel_->push_instances_of(of, transforms, options); },
            [&] { place(handle, model_.find(of)->geometry, states(transforms, options)); });
    }

    void append() {
        const AccelHandle handle = any_handle();
        const std::vector<Transform> transforms = source_.transforms(source_.below(3));
        const std::vector<InstanceOptions> options = source_.options(transforms.size());
        std::size_t first = 0;
        expect(
            model_.find(handle) && is_placeable(model_.find(handle)->geometry->unit, transforms, options),
            "append_instances", [&] { first = accel_->append_instances(handle, transforms, options); },
            [&] {
                std::vector<InstanceState>& instances = model_.find(handle)->instances;
                require(first == instances.size(), "append_instances returns the index of the first");
                for (const InstanceState& state : states(transforms, options)) instances.push_back(state);
                model_.mark(Pending::structure);
            });
    }

    void erase() {
        const AccelHandle handle = any_handle();
        ModelPlacing* placing = model_.find(handle);
        require(accel_->erase(handle) == (placing != nullptr), "erase() tells whether the handle was alive");
        if (!placing) return;
        model_.placings.erase(model_.placings.begin() + (placing - model_.placings.data()));
        model_.dead.push_back(handle);
        model_.mark(Pending::structure);
    }

    void erase_instance() {
        const AccelHandle handle = any_handle();
        const std::size_t index = source_.below(4);
        ModelPlacing* placing = model_.find(handle);
        expect(
            placing && index < placing->instances.size(), "erase_instance",
            [&] { accel_->erase_instance(handle, index); },
            [&] {
                placing->instances.erase(placing->instances.begin() + std::ptrdiff_t(index));
                model_.mark(Pending::structure);
            });
    }

    void update() {
        const AccelHandle handle = any_handle();
        const ModelGeometry geometry = source_.geometry();
        expect(
            model_.find(handle) && is_usable(geometry), "update",
            [&] {
                geometry.has_boxes ? accel_->update(handle, BoxesView{"boxes", geometry.boxes})
                                   : accel_->update(handle, geometry.mesh);
            },
            [&] {
                *model_.find(handle)->geometry = geometry;
                model_.mark(Pending::structure);
            });
    }

    void update_vertices() {
        const AccelHandle handle = any_handle();
        ModelPlacing* placing = model_.find(handle);
        const std::size_t count = placing ? placing->geometry->mesh.positions.size() : 0;
        const std::vector<vec3> positions = source_.points(count + (source_.below(8) == 0));
        expect(
            placing && !placing->geometry->has_boxes && positions.size() == count, "update_vertices",
            [&] { accel_->update_vertices(handle, positions); },
            [&] {
                placing->geometry->mesh.positions = positions;
                if (!placing->geometry->mesh.triangles.empty()) model_.mark(Pending::moves);
            });
    }

    void update_transforms() {
        const AccelHandle handle = any_handle();
        ModelPlacing* placing = model_.find(handle);
        const std::size_t count = placing ? placing->instances.size() : 0;
        const std::vector<Transform> transforms = source_.transforms(count + (source_.below(8) == 0));
        expect(
            placing && transforms.size() == count && is_placeable(placing->geometry->unit, transforms, {}),
            "update_transforms", [&] { accel_->update_transforms(handle, transforms); },
            [&] {
                for (std::size_t i = 0; i < count; ++i) placing->instances[i].transform = transforms[i];
                model_.mark(Pending::moves);
            });
    }

    void update_transform() {
        const AccelHandle handle = any_handle();
        const std::size_t index = source_.below(4);
        const bool is_named = source_.below(2) == 0;
        const Transform transform = source_.transform();
        ModelPlacing* placing = model_.find(handle);
        const std::size_t count = placing ? placing->instances.size() : 0;
        expect((is_named ? index < count : count == 1) &&
                   is_placeable(placing->geometry->unit, std::span(&transform, 1), {}),
               "update_transform",
               [&] {
                   is_named ? accel_->update_transform_at(handle, index, transform)
                            : accel_->update_transform(handle, transform);
               },
               [&] {
                   placing->instances[is_named ? index : 0].transform = transform;
                   model_.mark(Pending::moves);
               });
    }

    void update_options() {
        const AccelHandle handle = any_handle();
        const std::size_t index = source_.below(4);
        const InstanceOptions options = source_.options();
        ModelPlacing* placing = model_.find(handle);
        expect(
            placing && index < placing->instances.size() && options.custom_index < 1u << 24, "update_options",
            [&] { accel_->update_options(handle, index, options); },
            [&] {
                placing->instances[index].options = options;
                model_.mark(Pending::structure);
            });
    }

    void sync() {
        accel_->sync();
        model_.sync();
    }

    // Calls that fail while edits wait for a sync, or before the first one, and settings.
    void look() {
        expect(model_.pending == Pending::nothing, "view", [&] { seen_ = SeenView{accel_->view(), accel_count_}; });
        const AccelHandle handle = any_handle();
        expect(model_.find(handle) && model_.pending == Pending::nothing, "object_bound",
               [&] { accel_->object_bound(handle); });
        const double ratio = double(source_.number());
        expect(
            ratio >= 1, "set_rebuild_ratio", [&] { accel_->set_rebuild_ratio(ratio); },
            [&] { require(accel_->rebuild_ratio() == ratio, "the rebuild ratio is that which was set"); });
        expect(model_.revision > 0, "world_bound", [&] { accel_->world_bound(); });
    }

    // Traces through a view that may be stale, or of an earlier accelerator.
    void trace_view() {
        if (!seen_) return;
        Commands commands(shared_context(), "fuzz");
        expect(seen_->accel == accel_count_ && seen_->view.revision == model_.revision, "trace",
               [&] { accel_->trace(commands, seen_->view, {}); });
    }

    void ask_for_owners() {
        std::size_t instance = 0;
        for (const ModelPlacing& placing : model_.placings)
            for (std::size_t i = 0; i < placing.instances.size(); ++i, ++instance) {
                const Hit hit{1, 1, 0, 0, 0, 0, uint(instance), 0};
                expect(model_.pending == Pending::nothing, "handle_of", [&] {
                    require(accel_->handle_of(hit) == placing.handle && accel_->index_in_handle(hit) == i,
                            "a hit names the handle and the instance of it");
                });
            }
        const Hit beyond{1, 1, 0, 0, 0, 0, uint(instance), 0};
        expect(false, "handle_of", [&] { accel_->handle_of(beyond); });
    }

    void trace() {
        std::vector<Ray> rays;
        for (std::size_t left = 1 + source_.below(4); left > 0; --left) rays.push_back(source_.ray());
        const std::uint8_t mask = source_.below(4) == 0 ? source_.byte() : 0xff;
        const Cull cull = static_cast<Cull>(source_.below(3));
        const bool is_any = source_.below(2) == 0;
        const TraceDesc desc{.mask = mask, .cull = cull};
        std::vector<Hit> hits;
        model_.sync();
        expect(
            !model_.needs_program(), "closest_hits",
            [&] { hits = is_any ? accel_->any_hits(rays, desc) : accel_->closest_hits(rays, desc); },
            [&] {
                const std::vector<Hit> wanted = model_.closest_hits(rays, mask, cull);
                require(hits.size() == rays.size(), "there is a hit a ray");
                for (std::size_t i = 0; i < hits.size(); ++i) check_hit(hits[i], wanted[i], is_any);
            });
    }

    static void check_hit(const Hit& hit, const Hit& wanted, bool is_any) {
        require(hit.hit == wanted.hit, "a ray meets what it should");
        if (is_any || !hit.hit) return;
        require(hit.instance_index == wanted.instance_index && hit.primitive_index == wanted.primitive_index &&
                    hit.custom_index == wanted.custom_index && hit.t == wanted.t,
                "a hit is the closest, with the lowest ids");
    }

    Arguments source_;
    std::unique_ptr<AbstractAccel> accel_;
    AccelModel model_;
    int accel_count_ = 0;  // includes earlier ones
    struct SeenView {
        AccelView view;
        int accel;
    };
    std::optional<SeenView> seen_;
};

}  // namespace

void accel(Input input) { History(Arguments(input)).run(); }

}  // namespace twinray::fuzz
