// SPDX-License-Identifier: MIT
// Modules in which constants are known, word by word.
#include "engine/core/frozen_spirv.h"

#include <gtest/gtest.h>

namespace twinray {
namespace {

using Words = std::vector<std::uint32_t>;

constexpr std::uint32_t number = 1, boolean = 2;  // types
const Words header = {0x07230203, 0x00010500, 0, 32, 0};
const Words types = {4u << 16 | 21, number, 32, 0, 2u << 16 | 20, boolean};

Words module_of(std::initializer_list<Words> parts) {
    Words all;
    for (const Words& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}
Words spec_id(std::uint32_t of, std::uint32_t id) { return {4u << 16 | 71, of, 1, id}; }
Words spec_constant(std::uint32_t id, std::uint32_t standard) { return {4u << 16 | 50, number, id, standard}; }
Words constant(std::uint32_t id, std::uint32_t value) { return {4u << 16 | 43, number, id, value}; }
Words truth(std::uint32_t id, bool value) { return {3u << 16 | (value ? 41u : 42u), boolean, id}; }
Words operation(std::uint32_t type, std::uint32_t id, std::uint32_t op, const Words& operands) {
    Words words = {static_cast<std::uint32_t>(4 + operands.size()) << 16 | 52, type, id, op};
    words.insert(words.end(), operands.begin(), operands.end());
    return words;
}

TEST(FrozenSpirv, HasGivenValuesElseDefaults) {
    const Words module = module_of({header,
                                    spec_id(10, 100),
                                    spec_id(11, 101),
                                    types,
                                    spec_constant(10, 7),
                                    spec_constant(11, 8),
                                    {3u << 16 | 48, boolean, 12}});
    const std::vector<SpecializationConstant> given = {{100, 5}, {999, 1}};
    EXPECT_EQ(freeze_constants(module, given),
              module_of({header, types, constant(10, 5), constant(11, 8), truth(12, true)}));
}

TEST(FrozenSpirv, ABooleanIsGivenAsANumber) {
    const Words module = module_of({header, spec_id(10, 3), types, {3u << 16 | 48, boolean, 10}});
    const std::vector<SpecializationConstant> given = {{3, 0}};
    EXPECT_EQ(freeze_constants(module, given), module_of({header, types, truth(10, false)}));
}

TEST(FrozenSpirv, FoldsWhatIsComputedOfThem) {
    constexpr std::uint32_t bitwise_and = 199, not_equal = 171, select = 169;
    const Words module =
        module_of({header, spec_id(10, 100), types, spec_constant(10, 0), constant(11, 32), constant(12, 0),
                   operation(number, 13, bitwise_and, {10, 11}), operation(boolean, 14, not_equal, {13, 12}),
                   operation(number, 15, select, {14, 11, 12})});
    for (const std::uint32_t features : {0u, 48u}) {
        const bool has = (features & 32) != 0;
        const std::vector<SpecializationConstant> given = {{100, features}};
        EXPECT_EQ(freeze_constants(module, given),
                  module_of({header, types, constant(10, features), constant(11, 32), constant(12, 0),
                             constant(13, features & 32), truth(14, has), constant(15, has ? 32 : 0)}));
    }
}

TEST(FrozenSpirv, KeepsWhatItDoesNotKnow) {
    constexpr std::uint32_t float_multiply = 133, divide = 134;
    const Words unknown =
        module_of({header, types, constant(10, 6), constant(11, 0), operation(number, 12, float_multiply, {10, 10}),
                   operation(number, 13, divide, {10, 11}), operation(number, 14, divide, {12, 10})});
    EXPECT_EQ(freeze_constants(unknown, {}), unknown);
}

}  // namespace
}  // namespace twinray
