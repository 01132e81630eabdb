#include "cli/shards.h"

#include <charconv>
#include <exception>
#include <sstream>

#include <twinray/analysis.h>
#include "engine/core/files.h"
#include "twinray_version.h"

namespace twinray::cli {
namespace {

constexpr uint most_parts = 1'000'000;
constexpr std::string_view kind = "twinray shard 1\n";

// Reads "1/3".
bool read_part(const std::string& word, ShardOptions& options) {
    const char* const last = word.data() + word.size();
    const auto [slash, error] = std::from_chars(word.data(), last, options.index);
    if (error != std::errc() || slash == last || *slash != '/') return false;
    const auto [end, other] = std::from_chars(slash + 1, last, options.count);
    return other == std::errc() && end == last && options.index < options.count && options.count <= most_parts;
}

std::string head_of(const Agreement& agreement, Rows rows, std::uint64_t count) {
    std::ostringstream out;
    out << kind;
    for (const auto& [name, value] : agreement) out << name << ": " << value << '\n';
    out << "rows: " << rows.first << " to " << rows.last << " of " << count << "\n\n";
    return out.str();
}

void save_part(const std::filesystem::path& file, const std::string& head, std::span<const std::byte> bytes) {
    const auto text = std::as_bytes(std::span(head));
    const std::uint32_t sum = crc32_of(bytes, crc32_of(text));
    const std::vector<std::span<const std::byte>> pieces = {text, bytes, std::as_bytes(std::span(&sum, 1))};
    write_file(file, pieces);
}

// Throws Error with the first line that differs.
void check_head(const std::filesystem::path& file, std::string_view found, const std::string& wanted) {
    std::istringstream there{std::string(found)}, here{wanted};
    std::string is, should_be;
    while (std::getline(here, should_be)) {
        if (!std::getline(there, is)) is.clear();
        if (is != should_be)
            fail("'", file.string(), "' does not belong here: it has '", is, "', not '", should_be, "'");
    }
}

std::vector<std::byte> load_part(const std::filesystem::path& file, const std::string& head) {
    const Bytes bytes = read_file(file);
    const auto all = std::as_bytes(std::span(bytes));
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (!text.starts_with(kind)) fail("'", file.string(), "' is no shard of twinray");
    const std::size_t size = text.find("\n\n");
    std::uint32_t sum = 0;
    if (size == text.npos || all.size() < size + 2 + sizeof sum)
        fail("'", file.string(), "': it was cut short, ", bytes.size(), " bytes are left");
    check_head(file, text.substr(0, size + 2), head);
    std::memcpy(&sum, all.data() + all.size() - sizeof sum, sizeof sum);
    if (sum != crc32_of(all.first(all.size() - sizeof sum)))
        fail("'", file.string(), "': damaged (its checksum does not fit)");
    const auto rows = all.subspan(size + 2, all.size() - size - 2 - sizeof sum);
    return {rows.begin(), rows.end()};
}

}  // namespace

Section shard_options(ShardOptions& options, std::vector<std::string> whole, const std::string& output) {
    whole.insert(whole.end(), {"--merge", "--json"});
    Value part = {
        .kind = Value::Kind::word, .metavar = "K/N", .least = 1, .most = 1, .allowed = "K/N, K from 0 to N - 1"};
    part.store = [&options](std::span<const std::string> words) {
        return read_part(words.front(), options) ? nullptr : &words.front();
    };
    return {"Parts",
            {{.name = "--shard",
              .value = std::move(part),
              .help = "compute the K-th of N parts and write it beside the output, as OUTPUT.shardKofN; under mpirun "
                      "each rank does so by itself, and the first puts them together",
              .needs = {output},
              .excludes = std::move(whole)},
             {.name = "--merge",
              .value = number(options.merged, {1, most_parts}),
              .help = "put the N parts beside the output together, with all other options as they had; nothing is "
                      "computed again",
              .needs = {output}},
             {.name = "--resume",
              .value = flag(options.resumes),
              .help = "go on with what an earlier run with the same options left beside the output",
              .needs = {output}}}};
}

Agreement agreement_of(const std::string& command, const Scene& scene, const std::string& accel, Agreement more) {
    more.insert(more.begin(), {{"twinray", twinray_version},
                               {"command", command},
                               {"scene", text(count_triangles(scene), " triangles, checksum ", checksum_of(scene))},
                               {"accelerator", accel}});
    return more;
}

std::string checksum_text(std::span<const std::byte> bytes) {
    return text(bytes.size(), " bytes, checksum ", crc32_of(bytes));
}

Shards::Shards(const ShardOptions& options, CommonOptions& common, std::filesystem::path output)
    : options_(options), output_(std::move(output)) {
    if (ranks_.count() > 1) {
        if (options.count > 0 || options.merged > 0)
            throw UsageError("under mpirun there is no --shard and no --merge: ranks share the rows");
        if (output_.empty()) throw UsageError("under mpirun --output is required: parts lie beside it");
        index_ = ranks_.index(), count_ = ranks_.count();
        common.quiet |= index_ > 0;
        if (common.device.empty())
            common.device = std::to_string(samples::device_of_rank(list_devices(), ranks_.local_index()));
    } else {
        index_ = options.index, count_ = std::max(options.count, options.merged);
    }
    is_quiet_ = common.quiet;
}

Shards::~Shards() {
    if (std::uncaught_exceptions() > 0) ranks_.abandon();  // mpirun then ends the others
    std::error_code left;                                  // a part that stays is no fault
    if (ranks_.count() > 1 && ranks_.index() == 0 && std::uncaught_exceptions() == 0)
        for (uint part = 0; part < count_; ++part) std::filesystem::remove(file(part), left);
}

std::filesystem::path Shards::file(uint part) const {
    return std::filesystem::path(output_) += text(".shard", part, "of", count_);
}

Rows Shards::rows(uint part, std::uint64_t count) const {
    const auto begin = [&](std::uint64_t i) { return count / count_ * i + std::min<std::uint64_t>(i, count % count_); };
    return {begin(part), begin(part + 1)};
}

bool Shards::for_parts(std::uint64_t count, const Visit& save, const Visit& load) const {
    if (options_.merged == 0) save(rows(index_, count), file(index_));
    if (options_.count > 0) {
        if (!is_quiet_) {
            const Rows own = rows(index_, count);
            std::cout << "shard " << index_ << " of " << count_ << ": rows " << own.first << " to " << own.last
                      << " of " << count << " are in " << file(index_).string() << '\n';
        }
        return false;
    }
    ranks_.wait_for_all();
    if (ranks_.index() > 0) return false;
    for (uint part = 0; part < count_; ++part)
        if (!std::filesystem::exists(file(part)))
            fail("'", file(part).string(), "' is missing: --shard ", part, '/', count_, " writes it");
    for (uint part = 0; part < count_; ++part) load(rows(part, count), file(part));
    return true;
}

std::optional<std::vector<std::vector<std::byte>>> Shards::parts(std::uint64_t count, Agreement agreement,
                                                                 const Compute& compute) const {
    const auto head = [&](Rows rows) { return head_of(agreement, rows, count); };
    std::vector<std::vector<std::byte>> found;
    const bool goes_on = for_parts(
        count,
        [&](Rows rows, const std::filesystem::path& file) {
            if (options_.resumes && std::filesystem::exists(file)) return void(load_part(file, head(rows)));
            save_part(file, head(rows), compute(rows));
        },
        [&](Rows rows, const std::filesystem::path& file) { found.push_back(load_part(file, head(rows))); });
    if (!goes_on) return {};
    return found;
}

}  // namespace twinray::cli
