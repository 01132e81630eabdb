#include "engine/collide/pair_classifier.h"

#include <algorithm>

#include "collide_classify.spv.h"
#include "engine/core/error.h"
#include "engine/core/stopwatch.h"

namespace twinray {
namespace {

constexpr std::uint64_t chunk = 1 << 20;  // pairs whose results are downloaded at once: 16 MiB

void check(const WorldTriangle& t, std::size_t pair) {
    for (const dvec3& vertex : {t.a, t.b, t.c})
        if (const std::string fault = sign_fault_of(vertex); !fault.empty())
            fail("classify: pair ", pair, " has ", fault);
}

template <class T>
std::uint64_t offset_after(std::uint64_t offset, std::uint64_t count) {
    return (offset + count * sizeof(T) + 15) / 16 * 16;
}

}  // namespace

PairClassifier::PairClassifier(Context& context)
    : context_(context),
      kernel_(context, {.name = "collide_classify", .spirv = collide_classify_spirv}),
      total_(context, {.name = "collide contact total", .bytes = sizeof(ListTotal)}),
      pace_(context) {}

std::vector<ClassifiedPair> PairClassifier::classify(const DevicePairs& pairs, const Items& items) {
    host_count_ = 0;
    host_seconds_ = 0;
    std::vector<ClassifiedPair> classified;
    for (std::uint64_t begin = 0; begin < pairs.count; begin += chunk) {
        const std::uint64_t found = run(pairs, begin, static_cast<uint>(std::min(chunk, pairs.count - begin)), items);
        std::vector<PairContact> contacts = download<PairContact>(context_, contacts_, found);
        decide(contacts, items);
        for (const PairContact& contact : contacts)
            if (const auto pair_class = static_cast<PairClass>(contact.class_of_pair);
                pair_class != PairClass::separate)
                classified.push_back({contact.first, contact.second, pair_class});
    }
    return classified;
}

std::uint64_t PairClassifier::run(const DevicePairs& pairs, std::uint64_t begin, uint count, const Items& items) {
    grow(context_, contacts_, "collide contacts", count * sizeof(PairContact));
    Commands commands(context_, "collide classify");
    {
        const auto pass = commands.pass("collide classify start");
        commands.write(total_, ListTotal{0, 0});
    }
    pace_.record(commands, count, [&](std::uint64_t first, std::uint64_t some) {
        const std::uint64_t offset = (begin + first) * sizeof(uint);
        kernel_.dispatch(commands,
                         {.triangles = items.triangles,
                          .names = items.names,
                          .first = {pairs.first + offset},
                          .second = {pairs.second + offset},
                          .contacts = contacts_.ref<PairContact>(),
                          .total = total_.ref<ListTotal>(),
                          .count = static_cast<uint>(some),
                          .reserved = 0},
                         some);
    });
    pace_.finish(commands);
    return download<ListTotal>(context_, total_, 1).front().low;
}

void PairClassifier::decide(std::vector<PairContact>& contacts, const Items& items) {
    const Stopwatch start;
    for (PairContact& contact : contacts) {
        if (contact.class_of_pair != PAIR_UNDECIDED) continue;
        ++host_count_;
        contact.class_of_pair =
            static_cast<uint>(exact_class(items.host_triangle(contact.first), items.host_name(contact.first),
                                          items.host_triangle(contact.second), items.host_name(contact.second)));
    }
    host_seconds_ += start.seconds();
}

std::vector<PairClass> PairClassifier::classify(std::span<const TrianglePair> pairs) {
    std::vector<PairClass> classes(pairs.size(), PairClass::separate);
    if (pairs.empty()) return classes;
    if (pairs.size() > PairSearch::most_pairs / 2)
        fail("classify: ", pairs.size(), " pairs; at most ", PairSearch::most_pairs / 2, " at once");
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        check(pairs[i].a, i);
        check(pairs[i].b, i);
    }
    // Triangle 2 i is the first of pair i, 2 i + 1 the second; none share vertices.
    std::vector<TriangleName> names;
    std::vector<uint> items;
    for (uint i = 0; i < 2 * pairs.size(); ++i) names.push_back({uvec3(0, 1, 2), i});
    for (uint column = 0; column < 2; ++column)
        for (uint i = 0; i < pairs.size(); ++i) items.push_back(2 * i + column);
    const std::uint64_t names_at = offset_after<TrianglePair>(0, pairs.size());
    const std::uint64_t items_at = offset_after<TriangleName>(names_at, names.size());
    const Buffer data(context_, {.name = "collide given pairs", .bytes = items_at + items.size() * sizeof(uint)});
    Commands commands(context_, "collide given pairs");
    {
        const auto pass = commands.pass("collide given pairs");
        commands.upload(data, pairs);
        commands.upload(data, std::span<const TriangleName>(names), names_at);
        commands.upload(data, std::span<const uint>(items), items_at);
    }
    commands.submit();
    const std::uint64_t first = data.address() + items_at;
    const DevicePairs listed{first, first + pairs.size() * sizeof(uint), pairs.size(), &data};
    const auto triangle_of = [&](uint item) { return item % 2 ? pairs[item / 2].b : pairs[item / 2].a; };
    const auto name_of_item = [&](uint item) { return names[item]; };
    for (const ClassifiedPair& pair :
         classify(listed, {data.ref<WorldTriangle>(), data.ref<TriangleName>(names_at), triangle_of, name_of_item}))
        classes[pair.first / 2] = pair.pair_class;
    return classes;
}

}  // namespace twinray
