// SPDX-License-Identifier: MIT
#include "cli/kernels/kernel_list.h"

#include <algorithm>
#include <mutex>

#include "engine/accel/features_of.h"

namespace twinray::kernels {
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

// The kernels of a host that specialises a kernel or a program of its own for no scene.
void add_unspecialized(Collector& collector) {
    for (ListedKernel& kernel : collector.kernels()) {
        const auto features = std::ranges::find(kernel.desc.constants, FEATURES_CONSTANT, &SpecializationConstant::id);
        if (features == kernel.desc.constants.end()) continue;
        features->value = FEATURES_ALL;
        collector.add(kernel.desc, kernel.args_bytes);
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
