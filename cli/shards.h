// Parts of a command's work, computed apart and put together: by jobs with --shard and --merge, or by ranks of MPI.
#pragma once

#include <cstring>
#include <functional>
#include <utility>

#include "cli/common.h"
#include "samples/support/ranks.h"

namespace twinray::cli {

struct ShardOptions {
    uint index = 0, count = 0;  // --shard; count is 0 without it
    uint merged = 0;            // --merge; 0: none
    bool resumes = false;
};
// Returns --shard, --merge, --resume. `output`: the option for what is written; `whole`: options that need all parts.
Section shard_options(ShardOptions& options, std::vector<std::string> whole, const std::string& output = "--output");

struct Rows {
    std::uint64_t first, last;
    std::uint64_t count() const { return last - first; }
};

// The names and values on which all parts must agree.
using Agreement = std::vector<std::pair<std::string, std::string>>;

// Returns the version, the command, the scene and the accelerator ("" if there is none), then `more`.
Agreement agreement_of(const std::string& command, const Scene& scene, const std::string& accel, Agreement more);

class Shards {
  public:
    // Under mpirun all ranks but the first become quiet, and each takes a device of its own. Throws UsageError for
    // parts without an output.
    Shards(const ShardOptions& options, CommonOptions& common, std::filesystem::path output);
    ~Shards();
    Shards(const Shards&) = delete;
    Shards& operator=(const Shards&) = delete;

    // Computes `compute(rows)` of this process's part of `count` rows and saves it beside the output. Returns all
    // parts, in order, to the process that goes on, and nothing to one that is done. Without parts it is compute() of
    // all rows, and no file.
    using Compute = std::function<std::vector<std::byte>(Rows)>;
    std::optional<std::vector<std::vector<std::byte>>> parts(std::uint64_t count, Agreement agreement,
                                                             const Compute& compute) const;

    // Does the same for a command that saves parts itself: calls save(rows, file) for its own part, then load(rows,
    // file) for all, in order. Returns whether this process goes on.
    using Visit = std::function<void(Rows, const std::filesystem::path&)>;
    bool for_parts(std::uint64_t count, const Visit& save, const Visit& load) const;

    Rows rows(uint part, std::uint64_t count) const;
    bool is_whole() const { return count_ == 0; }

  private:
    std::filesystem::path file(uint part) const;

    ShardOptions options_;
    std::filesystem::path output_;
    samples::Ranks ranks_;
    uint index_ = 0, count_ = 0;  // of parts; 0: the work is not shared
    bool is_quiet_ = false;
};

// Joins two kinds of things into the bytes of a part; split() takes them apart, `count` of the first kind.
template <class A, class B>
std::vector<std::byte> joined(std::span<const A> a, std::span<const B> b) {
    std::vector<std::byte> bytes(a.size_bytes() + b.size_bytes());
    if (!a.empty()) std::memcpy(bytes.data(), a.data(), a.size_bytes());
    if (!b.empty()) std::memcpy(bytes.data() + a.size_bytes(), b.data(), b.size_bytes());
    return bytes;
}
template <class T>
void append_bytes(std::vector<T>& to, std::span<const std::byte> bytes) {
    const std::size_t before = to.size();
    to.resize(before + bytes.size() / sizeof(T));
    if (!bytes.empty()) std::memcpy(to.data() + before, bytes.data(), bytes.size());
}
template <class A, class B>
void split(std::span<const std::byte> bytes, std::size_t count, std::vector<A>& a, std::vector<B>& b) {
    append_bytes(a, bytes.first(count * sizeof(A)));
    append_bytes(b, bytes.subspan(count * sizeof(A)));
}

// Computes the rows of all parts; compute(rows) returns a vector of Row.
template <class Row, class Compute>
std::optional<std::vector<Row>> compute_rows(const Shards& shards, std::uint64_t count, Agreement agreement,
                                             const Compute& compute) {
    static_assert(std::is_trivially_copyable_v<Row>);
    if (shards.is_whole()) return compute(Rows{0, count});
    const auto parts = shards.parts(count, std::move(agreement), [&](Rows rows) {
        const std::vector<Row> computed = compute(rows);
        const auto bytes = std::as_bytes(std::span(computed));
        return std::vector<std::byte>(bytes.begin(), bytes.end());
    });
    if (!parts) return {};
    std::vector<Row> all;
    for (const std::vector<std::byte>& part : *parts) append_bytes(all, part);
    return all;
}

// Returns a value in the form that it has in an Agreement.
std::string checksum_text(std::span<const std::byte> bytes);

}  // namespace twinray::cli
