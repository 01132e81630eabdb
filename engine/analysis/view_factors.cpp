// SPDX-License-Identifier: MIT
#include "engine/analysis/view_factors.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "analysis_face_rays.spv.h"
#include "analysis_face_targets.spv.h"
#include "engine/analysis/row_sums.h"
#include "engine/core/error.h"
#include "engine/core/parallel.h"

namespace twinray {
namespace {

constexpr std::size_t batch_chunks = 1 << 14;
constexpr std::uint64_t first_rays = 1024;  // before the first look at errors
constexpr std::uint64_t most_rays = 1ull << 31;

void check(const ViewFactorOptions& options) {
    if (options.rays == 0 || options.rays > most_rays)
        fail("view factors: ", options.rays, " rays a row; they must be 1 to ", most_rays);
    if (const double error = options.target_error.value_or(1); !(error > 0))
        fail("view factors: a target error of ", error, "; it must be above 0");
}

std::uint64_t chunks_of(std::uint64_t rays) { return (rays + CHUNK - 1) / CHUNK; }

bool is_before(const ViewFactor& a, const ViewFactor& b) { return a.target < b.target; }

bool has(const std::vector<ViewFactor>& factors, uint target) {
    return std::binary_search(factors.begin(), factors.end(), ViewFactor{.target = target}, is_before);
}

// Whether contours add up to 1, as far as they are known: rays then meet nothing else.
bool is_full(const std::vector<ViewFactor>& known) {
    double left = 1;
    for (const ViewFactor& factor : known) left -= factor.by == PairEstimator::contour ? factor.high : 0;
    return left <= 0;
}

// Its interval has room for the roundings to float32.
ViewFactor factor_of(const KnownExchange& exchange, uint target, double area) {
    const auto low = static_cast<float>(exchange.low / area), high = static_cast<float>(exchange.high / area);
    const float value = std::min(1.0f, static_cast<float>(exchange.flow / area));
    return {target, value, std::nextafter(std::min(low, value), 0.0f), std::min(1.0f, std::nextafter(high, 2.0f)),
            exchange.by};
}

}  // namespace

// A face of a group gets rays by its area. A round takes chunks of it in proportion to `chunks`, so that weights stay.
struct ViewFactors::Row {
    struct Member {
        uint face;
        uint chunks;    // in the first round
        double weight;  // of a ray
    };
    uint group = 0;
    std::vector<Member> members;
    std::uint64_t rounds = 0;  // how often the rays of the first round have been taken
    RowSums sums = {};

    double total_weight() const {
        double sum = 0;
        for (const Member& member : members) sum += member.weight * member.chunks;
        return sum * SAMPLES_OF_CHUNK * static_cast<double>(rounds);
    }
    bool is_within(double error, const std::vector<ViewFactor>& known, Estimator& estimator) const {
        const double total = total_weight();
        return std::all_of(sums.entries().begin(), sums.entries().end(), [&](const RowSums::Entry& entry) {
            return has(known, entry.target) || sums.estimate(entry, total, estimator).half_width() <= error;
        });
    }
};

ViewFactors::ViewFactors(AbstractAccel& accel, const Faces& faces, const ViewFactorOptions& options,
                         std::span<const KnownExchange> known)
    : accel_(accel),
      faces_(faces),
      options_((check(options), options)),
      make_rays_(accel.context(), {.name = "analysis_face_rays", .spirv = analysis_face_rays_spirv}),
      find_targets_(accel.context(), {.name = "analysis_face_targets", .spirv = analysis_face_targets_spirv}),
      members_(faces.members(options.grouping)),
      areas_(faces.areas_of(members_)),
      known_(members_.size()),
      pace_(accel.context()) {
    check_filled(accel, faces.triangle_counts(), "view factors");
    for (const KnownExchange& exchange : known) {
        known_[exchange.i].push_back(factor_of(exchange, exchange.j, areas_[exchange.i]));
        if (exchange.i != exchange.j) known_[exchange.j].push_back(factor_of(exchange, exchange.i, areas_[exchange.j]));
    }
    for (std::vector<ViewFactor>& row : known_) std::sort(row.begin(), row.end(), is_before);
    Context& context = accel.context();
    if (options.grouping != FaceGrouping::face) {
        const std::vector<uint> groups = faces.groups(options.grouping);
        groups_ = Buffer(context, {.name = "groups of faces", .bytes = groups.size() * sizeof(uint)});
        Commands commands(context, "groups of faces");
        {
            const auto pass = commands.pass("groups of faces");
            commands.upload(groups_, std::span<const uint>(groups));
        }
        commands.submit();
    }
    constexpr std::uint64_t rays = batch_chunks * CHUNK;
    chunks_ =
        Buffer(context, {.name = "chunks of rays", .bytes = batch_chunks * sizeof(RayChunk), .memory = Memory::upload});
    rays_ = Buffer(context, {.name = "rays of faces", .bytes = rays * sizeof(Ray)});
    hits_ = Buffer(context, {.name = "hits of faces", .bytes = rays * sizeof(Hit)});
    targets_ = Buffer(context, {.name = "targets", .bytes = rays * sizeof(uint), .memory = Memory::readback});
}

std::size_t ViewFactors::block() const {
    return std::clamp<std::size_t>(batch_chunks / chunks_of(options_.target_error ? first_rays : options_.rays), 1,
                                   4096);
}

// How often the first round's rays are to have been taken after the next one: doubles while errors are above the
// target; none where the row is done.
std::uint64_t ViewFactors::rounds_of(const Row& row) {
    if (row.rounds == 0) return row.members.empty() ? 0 : 1;
    if (!options_.target_error || row.sums.rays() * 2 > options_.rays) return row.rounds;
    return row.is_within(*options_.target_error, known_[row.group], estimator_) ? row.rounds : row.rounds * 2;
}

std::vector<ViewFactorRow> ViewFactors::rows(std::size_t first, std::size_t last) {
    check_filled(accel_, faces_.triangle_counts(), "view factors");
    accel_.sync();
    std::vector<Row> rows(last - first);
    for (std::size_t i = first; i < last; ++i) {
        const bool is_short = options_.target_error || is_full(known_[i]);
        const std::uint64_t chunks = chunks_of(is_short ? std::min(first_rays, options_.rays) : options_.rays);
        Row& row = rows[i - first];
        row.group = static_cast<uint>(i);
        for (const uint face : members_[i]) {
            const double share = faces_.areas()[face] / areas_[i];
            const auto own =
                std::max<std::uint64_t>(1, static_cast<std::uint64_t>(share * static_cast<double>(chunks)));
            row.members.push_back(
                {face, static_cast<uint>(own), share * static_cast<double>(chunks) / static_cast<double>(own)});
        }
    }
    std::vector<Row*> open;
    for (Row& row : rows) open.push_back(&row);
    for (;;) {
        std::erase_if(open, [&](Row* row) { return rounds_of(*row) == row->rounds; });
        if (open.empty()) return results(rows);
        trace(open);
    }
}

// The next round of each.
void ViewFactors::trace(std::vector<Row*>& rows) {
    struct Owner {
        Row* row;
        double weight;
    };
    std::vector<RayChunk> chunks;
    std::vector<Owner> owners;
    const auto flush = [&] {
        if (chunks.empty()) return;
        trace_batch(chunks);
        const auto* targets = reinterpret_cast<const uint*>(targets_.mapped());
        for (std::size_t i = 0; i < chunks.size(); ++i)
            owners[i].row->sums.add({targets + i * CHUNK, CHUNK}, owners[i].weight);
        std::vector<Row*> touched;
        for (const Owner& owner : owners)
            if (touched.empty() || touched.back() != owner.row) touched.push_back(owner.row);
        parallel_for(touched.size(), [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) touched[i]->sums.settle();
        });
        chunks.clear();
        owners.clear();
    };
    for (Row* row : rows) {
        const std::uint64_t next = std::max<std::uint64_t>(1, row->rounds * 2);
        for (const Row::Member& member : row->members)
            for (std::uint64_t chunk = member.chunks * row->rounds; chunk < member.chunks * next; ++chunk) {
                chunks.push_back({member.face, static_cast<uint>(chunk * SAMPLES_OF_CHUNK)});
                owners.push_back({row, member.weight});
                if (chunks.size() == batch_chunks) flush();
            }
        row->rounds = next;
    }
    flush();
}

void ViewFactors::trace_batch(std::span<const RayChunk> chunks) {
    std::memcpy(chunks_.mapped(), chunks.data(), chunks.size_bytes());
    const std::uint64_t count = chunks.size() * CHUNK;
    const uint is_two_sided = options_.sides == Sides::both ? 1 : 0;
    const auto rays = rays_.ref<Ray>();
    const auto hits = hits_.ref<Hit>();
    Commands commands(accel_.context(), "view factors");
    make_rays_.dispatch(commands,
                        {faces_.table(), chunks_.ref<RayChunk>(), rays, options_.seed,
                         options_.sequence == Sequence::sobol ? SEQUENCE_SOBOL : SEQUENCE_RANDOM, is_two_sided, 0},
                        count);
    accel_.trace(commands, accel_.view(), {.rays = rays, .hits = hits, .count = count}, pace_);
    find_targets_.dispatch(
        commands,
        {faces_.table(), rays, hits, {groups_.address()}, targets_.ref<uint>(), static_cast<uint>(count), is_two_sided},
        count);
    pace_.finish(commands);
}

std::vector<ViewFactorRow> ViewFactors::results(const std::vector<Row>& rows) {
    std::vector<ViewFactorRow> results;
    for (const Row& row : rows) {
        const std::vector<ViewFactor>& known = known_[row.group];
        ViewFactorRow result;
        result.group = row.group;
        result.rays = result.hits = row.sums.rays();
        const double total = row.total_weight();
        result.open = result.back = estimator_({}, 0, result.rays);
        std::vector<ViewFactor> counted;
        for (const RowSums::Entry& entry : row.sums.entries()) {
            const Estimate estimate = row.sums.estimate(entry, total, estimator_);
            if (entry.target == TARGET_OPEN || entry.target == TARGET_BACK) {
                (entry.target == TARGET_OPEN ? result.open : result.back) = estimate;
                result.hits -= entry.hits;
            } else if (!has(known, entry.target)) {
                counted.push_back({entry.target, static_cast<float>(estimate.value),
                                   static_cast<float>(estimate.interval_95.low),
                                   static_cast<float>(estimate.interval_95.high), PairEstimator::hits});
            }
        }
        std::merge(counted.begin(), counted.end(), known.begin(), known.end(), std::back_inserter(result.factors),
                   is_before);
        results.push_back(std::move(result));
    }
    return results;
}

}  // namespace twinray
