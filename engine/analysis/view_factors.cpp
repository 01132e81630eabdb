#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "analysis_face_rays.spv.h"
#include "analysis_face_targets.spv.h"
#include "engine/analysis/faces.h"
#include "engine/analysis/estimate.h"
#include "engine/core/error.h"
#include "engine/core/commands.h"
#include "engine/core/parallel.h"

namespace twinray {
namespace {

static_assert(REPLICATES == replicate_count && CHUNK == REPLICATES * SAMPLES_OF_CHUNK);

constexpr std::size_t ray_chunks_of_batch = 1 << 14;
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

// Returns whether the known contours add up to 1: rays then meet nothing else.
bool is_full(const std::vector<ViewFactor>& known) {
    double left = 1;
    for (const ViewFactor& factor : known) left -= factor.by == PairEstimator::contour ? factor.high : 0;
    return left <= 0;
}

// Makes a factor whose interval has room for the roundings to float32.
ViewFactor factor_of(const KnownExchange& exchange, uint target, double area) {
    const auto low = static_cast<float>(exchange.low / area), high = static_cast<float>(exchange.high / area);
    const float value = std::min(1.0f, static_cast<float>(exchange.flow / area));
    return {target, value, std::nextafter(std::min(low, value), 0.0f), std::min(1.0f, std::nextafter(high, 2.0f)),
            exchange.by};
}

// Faces of a group get rays by area. A round takes chunks of each in proportion to `chunks`, so that weights stay.
struct Row {
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
    bool is_within(double error, const std::vector<ViewFactor>& known, FractionEstimator& estimator) const {
        const double total = total_weight();
        return std::all_of(sums.entries().begin(), sums.entries().end(), [&](const RowSums::Entry& entry) {
            return has(known, entry.target) || sums.estimate(entry, total, estimator).half_width() <= error;
        });
    }
};

std::vector<std::vector<ViewFactor>> factors_of(std::span<const KnownExchange> known,
                                                const std::vector<double>& areas) {
    std::vector<std::vector<ViewFactor>> factors(areas.size());
    for (const KnownExchange& exchange : known) {
        factors[exchange.i].push_back(factor_of(exchange, exchange.j, areas[exchange.i]));
        if (exchange.i != exchange.j) factors[exchange.j].push_back(factor_of(exchange, exchange.i, areas[exchange.j]));
    }
    for (std::vector<ViewFactor>& row : factors) std::sort(row.begin(), row.end(), is_before);
    return factors;
}

// Returns null if each face is a group of its own.
Buffer groups_on_device(Context& context, const Faces& faces, FaceGrouping grouping) {
    if (grouping == FaceGrouping::face) return {};
    const std::vector<uint> groups = faces.groups(grouping);
    return uploaded(context, "groups of faces", std::span<const uint>(groups));
}

}  // namespace

struct ViewFactors::State {
    State(AbstractAccel& accel_of_faces, const Faces& all_faces, const ViewFactorOptions& checked_options,
          std::span<const KnownExchange> known_exchanges);

    Row row_of(std::size_t group) const;
    std::uint64_t rounds_of(const Row& row);
    void trace(std::vector<Row*>& rows);
    void trace_batch(std::span<const RayChunk> batch);
    ViewFactorRow result_of(const Row& row);

    AbstractAccel& accel;
    const Faces& faces;
    ViewFactorOptions options;
    Kernel<FaceRaysArgs> make_rays;
    Kernel<FaceTargetsArgs> find_targets;
    std::vector<std::vector<uint>> members;  // faces with an area, by group
    std::vector<double> areas;
    std::vector<std::vector<ViewFactor>> known;  // of each row, ascending by target
    FractionEstimator estimator;
    Buffer groups, chunks, rays, hits, targets;
    Pace pace;
};

ViewFactors::State::State(AbstractAccel& accel_of_faces, const Faces& all_faces,
                          const ViewFactorOptions& checked_options, std::span<const KnownExchange> known_exchanges)
    : accel(accel_of_faces),
      faces(all_faces),
      options(checked_options),
      make_rays(accel.context(), {.name = "analysis_face_rays", .spirv = analysis_face_rays_spirv}),
      find_targets(accel.context(), {.name = "analysis_face_targets", .spirv = analysis_face_targets_spirv}),
      members(faces.members(options.grouping)),
      areas(faces.areas_of(members)),
      known(factors_of(known_exchanges, areas)),
      groups(groups_on_device(accel.context(), faces, options.grouping)),
      pace(accel.context()) {
    constexpr std::uint64_t most = ray_chunks_of_batch * CHUNK;
    Context& context = accel.context();
    chunks = Buffer(
        context, {.name = "chunks of rays", .bytes = ray_chunks_of_batch * sizeof(RayChunk), .memory = Memory::upload});
    rays = Buffer(context, {.name = "rays of faces", .bytes = most * sizeof(Ray)});
    hits = Buffer(context, {.name = "hits of faces", .bytes = most * sizeof(Hit)});
    targets = Buffer(context, {.name = "targets", .bytes = most * sizeof(uint), .memory = Memory::readback});
}

ViewFactors::ViewFactors(AbstractAccel& accel, const Faces& faces, const ViewFactorOptions& options,
                         std::span<const KnownExchange> known) {
    check(options);
    check_faces(accel, faces, "view factors");
    state_ = std::make_unique<State>(accel, faces, options, known);
}
ViewFactors::~ViewFactors() = default;

std::size_t ViewFactors::row_count() const { return state_->members.size(); }
const std::vector<double>& ViewFactors::areas() const { return state_->areas; }

std::size_t ViewFactors::batch_size() const {
    const ViewFactorOptions& options = state_->options;
    return std::clamp<std::size_t>(ray_chunks_of_batch / chunks_of(options.target_error ? first_rays : options.rays), 1,
                                   4096);
}

// Returns the number of times that the first round's rays are taken after the next round: doubles while errors are
// above the target; none if the row is done.
std::uint64_t ViewFactors::State::rounds_of(const Row& row) {
    if (row.rounds == 0) return row.members.empty() ? 0 : 1;
    if (!options.target_error || row.sums.rays() * 2 > options.rays) return row.rounds;
    return row.is_within(*options.target_error, known[row.group], estimator) ? row.rounds : row.rounds * 2;
}

Row ViewFactors::State::row_of(std::size_t group) const {
    const bool is_short = options.target_error || is_full(known[group]);
    const auto wanted = static_cast<double>(chunks_of(is_short ? std::min(first_rays, options.rays) : options.rays));
    Row row{.group = static_cast<uint>(group), .members = {}};
    for (const uint face : members[group]) {
        const double share = faces.areas()[face] / areas[group];
        const auto own = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(share * wanted));
        row.members.push_back({face, static_cast<uint>(own), share * wanted / static_cast<double>(own)});
    }
    return row;
}

std::vector<ViewFactorRow> ViewFactors::rows(std::size_t first, std::size_t last) {
    check_faces(state_->accel, state_->faces, "view factors");
    state_->accel.sync();
    std::vector<Row> rows;
    for (std::size_t i = first; i < last; ++i) rows.push_back(state_->row_of(i));
    std::vector<Row*> open;
    for (Row& row : rows) open.push_back(&row);
    for (;;) {
        std::erase_if(open, [&](Row* row) { return state_->rounds_of(*row) == row->rounds; });
        if (open.empty()) break;
        state_->trace(open);
    }
    std::vector<ViewFactorRow> results;
    for (const Row& row : rows) results.push_back(state_->result_of(row));
    return results;
}

// Traces the next round of each.
void ViewFactors::State::trace(std::vector<Row*>& rows) {
    struct Owner {
        Row* row;
        double weight;
    };
    std::vector<RayChunk> batch;
    std::vector<Owner> owners;
    const auto flush = [&] {
        if (batch.empty()) return;
        trace_batch(batch);
        const auto* met = reinterpret_cast<const uint*>(targets.mapped());
        for (std::size_t i = 0; i < batch.size(); ++i)
            owners[i].row->sums.add({met + i * CHUNK, CHUNK}, owners[i].weight);
        std::vector<Row*> touched;
        for (const Owner& owner : owners)
            if (touched.empty() || touched.back() != owner.row) touched.push_back(owner.row);
        parallel_for(touched.size(), [&](std::size_t i) { touched[i]->sums.settle(); });
        batch.clear();
        owners.clear();
    };
    for (Row* row : rows) {
        const std::uint64_t next = std::max<std::uint64_t>(1, row->rounds * 2);
        for (const Row::Member& member : row->members)
            for (std::uint64_t chunk = member.chunks * row->rounds; chunk < member.chunks * next; ++chunk) {
                batch.push_back({member.face, static_cast<uint>(chunk * SAMPLES_OF_CHUNK)});
                owners.push_back({row, member.weight});
                if (batch.size() == ray_chunks_of_batch) flush();
            }
        row->rounds = next;
    }
    flush();
}

void ViewFactors::State::trace_batch(std::span<const RayChunk> batch) {
    std::memcpy(chunks.mapped(), batch.data(), batch.size_bytes());
    const std::uint64_t count = batch.size() * CHUNK;
    const uint is_two_sided = options.sides == Sides::both ? 1 : 0;
    const auto made = rays.ref<Ray>();
    const auto met = hits.ref<Hit>();
    Commands commands(accel.context(), "view factors");
    make_rays.dispatch(commands,
                       {faces.state().table(), chunks.ref<RayChunk>(), made, options.seed,
                        options.sequence == Sequence::sobol ? SEQUENCE_SOBOL : SEQUENCE_RANDOM, is_two_sided, 0},
                       count);
    accel.trace(commands, accel.view(), {.rays = made, .hits = met, .count = count}, pace);
    find_targets.dispatch(commands,
                          {faces.state().table(),
                           made,
                           met,
                           {groups.address()},
                           targets.ref<uint>(),
                           static_cast<uint>(count),
                           is_two_sided},
                          count);
    pace.finish(commands);
}

ViewFactorRow ViewFactors::State::result_of(const Row& row) {
    ViewFactorRow result;
    result.group = row.group;
    result.rays = result.hits = row.sums.rays();
    const double total = row.total_weight();
    result.open = result.back = estimator({}, 0, result.rays);
    std::vector<ViewFactor> counted;
    for (const RowSums::Entry& entry : row.sums.entries()) {
        const Estimate estimate = row.sums.estimate(entry, total, estimator);
        if (entry.target == TARGET_OPEN || entry.target == TARGET_BACK) {
            (entry.target == TARGET_OPEN ? result.open : result.back) = estimate;
            result.hits -= entry.hits;
        } else if (!has(known[row.group], entry.target)) {
            counted.push_back({entry.target, static_cast<float>(estimate.value),
                               static_cast<float>(estimate.interval_95.low),
                               static_cast<float>(estimate.interval_95.high), PairEstimator::hits});
        }
    }
    std::merge(counted.begin(), counted.end(), known[row.group].begin(), known[row.group].end(),
               std::back_inserter(result.factors), is_before);
    return result;
}

}  // namespace twinray
