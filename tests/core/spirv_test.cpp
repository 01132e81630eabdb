// SPIR-V with known constants, word by word, and branches that they decide, as text.
#include <gtest/gtest.h>

#include "engine/accel/trace_desc.h"
#include "engine/core/radix_sort.h"
#include "engine/core/spirv_words.h"
#include "tests/scene/temp_dir.h"
#include "tests/support/device.h"

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

class PrunedSpirv : public ::testing::Test {
  protected:
    void SetUp() override {
        if (std::system(SPIRV_AS " --version") != 0)
            TWINRAY_LACKS("spirv_tools", "the shell here cannot run " SPIRV_AS);
    }
    void run(const std::string& command) const {
        EXPECT_EQ(std::system(("cd " + (folder_ / "").string() + " && " + command).c_str()), 0) << command;
    }
    Words read(const std::string& file) const {
        const Bytes bytes = read_file(folder_ / file);
        Words words(bytes.size() / 4);
        std::memcpy(words.data(), bytes.data(), 4 * words.size());
        return words;
    }
    void write(const std::string& file, const Words& words) const {
        folder_.write(file, {reinterpret_cast<const char*>(words.data()), 4 * words.size()});
    }
    // Returns the rest of a kernel as text, which spirv-val finds valid. `functions` come beside main; each text has an
    // instruction %gone and one %kept, both with a name and a decoration.
    std::string pruned(const std::string& main, const std::string& functions = "") const {
        std::ofstream(folder_ / "before.txt") << R"(
            OpCapability Shader
            OpMemoryModel Logical GLSL450
            OpEntryPoint GLCompute %main "main" %out
            OpExecutionMode %main LocalSize 1 1 1
            OpName %main "main"
            OpName %gone "gone"
            OpName %kept "kept"
            OpDecorate %gone NoContraction
            OpDecorate %kept NoContraction
            OpDecorate %out DescriptorSet 0
            OpDecorate %out Binding 0
            OpDecorate %block Block
            OpMemberDecorate %block 0 Offset 0
            %void = OpTypeVoid
            %bool = OpTypeBool
            %float = OpTypeFloat 32
            %uint = OpTypeInt 32 0
            %procedure = OpTypeFunction %void
            %block = OpTypeStruct %float
            %to_block = OpTypePointer StorageBuffer %block
            %to_float = OpTypePointer StorageBuffer %float
            %true = OpConstantTrue %bool
            %false = OpConstantFalse %bool
            %options = OpTypeStruct %uint %uint
            %zero = OpConstant %uint 0
            %six = OpConstant %uint 6
            %four = OpConstant %uint 4
            %one = OpConstant %float 1
            %out = OpVariable %to_block StorageBuffer
            %main = OpFunction %void None %procedure
            %begin = OpLabel
            %at = OpAccessChain %to_float %out %zero
            %value = OpLoad %float %at
            %unknown = OpFOrdLessThan %bool %value %one
            )" << main << "\nOpFunctionEnd\n" << functions;
        run(SPIRV_AS " --target-env vulkan1.2 before.txt -o before.spv && " SPIRV_VAL
                     " --target-env vulkan1.2 before.spv");
        write("after.spv", prune_branches(read("before.spv")));
        run(SPIRV_VAL " --target-env vulkan1.2 after.spv && " SPIRV_DIS
                      " --no-header --no-indent after.spv -o after.txt");
        const Bytes bytes = read_file(folder_ / "after.txt");
        return {bytes.begin(), bytes.end()};
    }

    const test::TempDir folder_;
};

std::size_t count(const std::string& all, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = all.find(part); at != std::string::npos; at = all.find(part, at + 1)) ++found;
    return found;
}

TEST_F(PrunedSpirv, TheSideThatIsNeverTakenGoesWithItsNames) {
    const std::string left = pruned(R"(
        OpSelectionMerge %end None
        OpBranchConditional %true %yes %no
        %yes = OpLabel
        %kept = OpFAdd %float %value %one
        OpBranch %end
        %no = OpLabel
        %gone = OpFMul %float %value %one
        OpBranch %end
        %end = OpLabel
        %either = OpPhi %float %kept %yes %gone %no
        OpStore %at %either
        OpReturn)");
    EXPECT_EQ(count(left, "gone"), 0u) << left;
    EXPECT_EQ(count(left, "%kept = OpFAdd"), 1u) << left;
    EXPECT_EQ(count(left, "OpPhi %float %kept"), 1u) << left;
    EXPECT_EQ(count(left, "OpSelectionMerge") + count(left, "OpBranchConditional"), 0u) << left;
}

TEST_F(PrunedSpirv, ABranchOnWhatIsNotKnownStays) {
    const std::string main = R"(
        OpSelectionMerge %end None
        OpBranchConditional %unknown %yes %end
        %yes = OpLabel
        %kept = OpFAdd %float %value %one
        %gone = OpFMul %float %value %one
        OpStore %at %kept
        OpBranch %end
        %end = OpLabel
        OpReturn)";
    const std::string left = pruned(main);
    EXPECT_EQ(count(left, "%gone = OpFMul"), 1u) << left;
    EXPECT_EQ(count(left, "OpSelectionMerge"), 1u) << left;
}

// Decides `false && unknown` by a branch, as GLSL's && is compiled, and by operators.
TEST_F(PrunedSpirv, ConditionsThatFollowAreKnown) {
    const std::string left = pruned(R"(
        OpSelectionMerge %joined None
        OpBranchConditional %false %right %joined
        %right = OpLabel
        OpBranch %joined
        %joined = OpLabel
        %both = OpPhi %bool %false %begin %unknown %right
        %neither = OpLogicalNot %bool %both
        %never = OpLogicalAnd %bool %neither %false
        %always = OpLogicalOr %bool %unknown %neither
        OpSelectionMerge %next None
        OpBranchConditional %never %then %next
        %then = OpLabel
        %gone = OpFMul %float %value %one
        OpStore %at %gone
        OpBranch %next
        %next = OpLabel
        OpSelectionMerge %end None
        OpBranchConditional %always %last %end
        %last = OpLabel
        %kept = OpFAdd %float %value %one
        OpStore %at %kept
        OpBranch %end
        %end = OpLabel
        OpReturn)");
    EXPECT_EQ(count(left, "gone"), 0u) << left;
    EXPECT_EQ(count(left, "OpBranchConditional"), 0u) << left;
    EXPECT_EQ(count(left, "%kept = OpFAdd"), 1u) << left;
}

// A bit of a number that was put into a struct, taken out and carried round a loop unchanged.
TEST_F(PrunedSpirv, NumbersThatFollowAreKnown) {
    const auto loop_with = [](const std::string& carried_on) {
        return R"(
        %asked = OpCompositeConstruct %options %zero %six
        %features = OpCompositeExtract %uint %asked 1
        OpBranch %head
        %head = OpLabel
        %carried = OpPhi %uint %features %begin )" +
               carried_on + R"( %again
        OpLoopMerge %end %again None
        OpBranch %body
        %body = OpLabel
        %bit = OpBitwiseAnd %uint %carried %four
        %lacks = OpIEqual %bool %bit %zero
        OpSelectionMerge %after None
        OpBranchConditional %lacks %then %after
        %then = OpLabel
        %gone = OpFMul %float %value %one
        OpStore %at %gone
        OpBranch %after
        %after = OpLabel
        %kept = OpFAdd %float %value %one
        OpStore %at %kept
        OpBranch %again
        %again = OpLabel
        %next = OpIAdd %uint %carried %four
        OpBranchConditional %unknown %head %end
        %end = OpLabel
        OpReturn)";
    };
    const std::string left = pruned(loop_with("%carried"));
    EXPECT_EQ(count(left, "gone"), 0u) << left;
    EXPECT_EQ(count(left, "%kept = OpFAdd"), 1u) << left;
    EXPECT_EQ(count(pruned(loop_with("%next")), "%gone = OpFMul"), 1u) << "it changes from turn to turn";
}

// The loop ends in its first iteration; it still has a back edge, with a value that is never used.
TEST_F(PrunedSpirv, ALoopThatDoesNotGoRoundStaysALoop) {
    const std::string left = pruned(R"(
        OpBranch %head
        %head = OpLabel
        %sum = OpPhi %float %value %begin %gone %again
        OpLoopMerge %end %again None
        OpBranch %body
        %body = OpLabel
        %kept = OpFAdd %float %sum %one
        OpBranchConditional %true %end %again
        %again = OpLabel
        %gone = OpFMul %float %kept %one
        OpBranch %head
        %end = OpLabel
        OpStore %at %kept
        OpReturn)");
    EXPECT_EQ(count(left, "gone"), 0u) << left;
    EXPECT_EQ(count(left, "OpLoopMerge"), 1u) << left;
    EXPECT_EQ(count(left, "OpUndef %float"), 1u) << left;
    EXPECT_EQ(count(left, "OpBranchConditional"), 0u) << left;
}

TEST_F(PrunedSpirv, TheWayBackOfALoopStays) {
    const std::string left = pruned(R"(
        OpBranch %head
        %head = OpLabel
        OpLoopMerge %end %again None
        OpBranch %body
        %body = OpLabel
        OpSelectionMerge %after None
        OpBranchConditional %false %then %after
        %then = OpLabel
        %gone = OpFMul %float %value %one
        OpBranch %after
        %after = OpLabel
        %kept = OpFAdd %float %value %one
        OpStore %at %kept
        OpBranch %again
        %again = OpLabel
        OpBranchConditional %false %head %end
        %end = OpLabel
        OpReturn)");
    EXPECT_EQ(count(left, "gone"), 0u) << left;
    EXPECT_EQ(count(left, "OpBranchConditional %false"), 1u) << left;
}

TEST_F(PrunedSpirv, WhatAnUnknownBranchNeedsStaysThoughNothingGetsThere) {
    const std::string left = pruned(R"(
        OpSelectionMerge %end None
        OpBranchConditional %unknown %yes %no
        %yes = OpLabel
        %kept = OpFAdd %float %value %one
        OpStore %at %kept
        OpBranchConditional %true %out_of_here %end
        %out_of_here = OpLabel
        OpReturn
        %no = OpLabel
        OpReturn
        %end = OpLabel
        %gone = OpFMul %float %value %one
        OpStore %at %gone
        OpReturn)");
    EXPECT_EQ(count(left, "gone"), 0u) << left;
    EXPECT_EQ(count(left, "OpUnreachable"), 1u) << left;
}

TEST_F(PrunedSpirv, FunctionsThatAreNotCalledGo) {
    const std::string left = pruned(
        R"(
        OpSelectionMerge %end None
        OpBranchConditional %false %yes %end
        %yes = OpLabel
        %nothing = OpFunctionCall %void %first
        OpBranch %end
        %end = OpLabel
        %something = OpFunctionCall %void %third
        OpReturn)",
        R"(
        %first = OpFunction %void None %procedure
        %in_first = OpLabel
        %more = OpFunctionCall %void %second
        OpReturn
        OpFunctionEnd
        %second = OpFunction %void None %procedure
        %in_second = OpLabel
        %gone = OpFMul %float %one %one
        OpReturn
        OpFunctionEnd
        %third = OpFunction %void None %procedure
        %in_third = OpLabel
        %kept = OpFAdd %float %one %one
        OpReturn
        OpFunctionEnd)");
    EXPECT_EQ(count(left, "gone"), 0u) << left;
    EXPECT_EQ(count(left, "OpFunctionEnd"), 2u) << left;
    EXPECT_EQ(count(left, "%kept = OpFAdd"), 1u) << left;
}

TEST(SpirvWords, FillAModuleInstructionByInstruction) {
    const auto with = [](const Words& more) { return module_of({header, more}); };
    const Words one = {2u << 16 | 20, 1};
    EXPECT_TRUE(spirv::is_module(with(one)));
    EXPECT_EQ(prune_branches(with(one)), with(one)) << "it has no function";
    EXPECT_FALSE(spirv::is_module(with({3u << 16 | 20, 1}))) << "cut short";
    EXPECT_FALSE(spirv::is_module(with({0}))) << "an instruction of no words";
    EXPECT_FALSE(spirv::is_module({}));
    EXPECT_FALSE(spirv::is_module(Words{1, 2, 3, 4, 5})) << "another magic number";
}

// Prunes modules with their own constants, with all but group sizes 0, and with random ones.
TEST_F(PrunedSpirv, EveryModuleOfTheBuildIsValidAfterwards) {
    std::mt19937 random(1);
    std::ifstream list(TWINRAY_MODULE_LIST);
    std::string files;
    std::size_t words_before = 0, words_after = 0;
    for (std::string module; std::getline(list, module);) {
        const Words before = read(module);
        std::set<Words> seen;
        for (int lot = 0; lot < 3; ++lot) {
            std::vector<SpecializationConstant> constants;
            for (std::uint32_t id = 0; id < 128 && lot > 0; ++id)
                if (id != GROUP_SIZE_CONSTANT && id != RAY_GROUP_CONSTANT)
                    constants.push_back({id, lot == 1 ? 0u : static_cast<std::uint32_t>(random() & 1)});
            const Words after = prune_branches(freeze_constants(before, constants));
            if (!seen.insert(after).second) continue;
            words_before += before.size();
            words_after += after.size();
            const std::string file = text(std::filesystem::path(module).stem().string(), "_", lot, ".spv");
            write(file, after);
            files += file + '\n';
        }
    }
    ASSERT_GT(std::count(files.begin(), files.end(), '\n'), 200);
    EXPECT_LT(words_after, words_before * 9 / 10);
    folder_.write("files.txt", files);
    run("xargs -n 1 " SPIRV_VAL " --target-env vulkan1.2 --scalar-block-layout < files.txt");
}

}  // namespace
}  // namespace twinray
