// A store of textures, as images or in buffers, and a kernel that reads them.
#pragma once

#include <twinray/scene.h>

#include "engine/core/kernel.h"
#include "test_texture_buffers.spv.h"
#include "test_texture_buffers_debug.spv.h"
#include "test_texture_images.spv.h"
#include "test_texture_images_debug.spv.h"
#include "tests/support/device.h"
#include "report/faults/fault_injection.h"

namespace twinray::test {
#include "twinray/glsl/cpp_begin.h"
#include "tests/scene/texture_kernel.h"
#include "twinray/glsl/cpp_end.h"
static_assert(sizeof(TextureQuestion) == 24 && sizeof(TextureAnswer) == 60);

class Textures : public VulkanTest, public ::testing::WithParamInterface<TextureStorage> {
  protected:
    ContextDesc context_desc() const override { return {.get_instance_proc_addr = injector_.entry()}; }
    void prepare() override {
        if (GetParam() == TextureStorage::images && !context().properties().has_image_arrays())
            TWINRAY_LACKS("descriptor_indexing", "no descriptor indexing");
        store_ = &keep<TextureStore>(context(), "textures", GetParam());
    }
    TextureStore& store() { return *store_; }

    // Records the questions; the answers are there when the commands are done.
    Buffer record_questions(Commands& commands, const std::vector<TextureQuestion>& questions, bool is_debug = false) {
        const std::span<const uint> modules[] = {test_texture_buffers_spirv, test_texture_buffers_debug_spirv,
                                                 test_texture_images_spirv, test_texture_images_debug_spirv};
        const Kernel<TextureTestArgs> kernel(context(), {.name = "test_texture",
                                                         .spirv = modules[2 * store().has_images() + is_debug],
                                                         .has_images = store().has_images()});
        Buffer answers(context(), {.name = "answers", .bytes = questions.size() * sizeof(TextureAnswer)});
        Buffer asked(context(), {.name = "questions", .bytes = questions.size() * sizeof(TextureQuestion)});
        {
            const auto pass = commands.pass("questions");
            commands.upload(asked, std::span(questions));
        }
        const auto count = static_cast<uint>(questions.size());
        kernel.dispatch(commands, {store().view(), asked.ref<TextureQuestion>(), answers.ref<TextureAnswer>(), count},
                        count, store().images());
        commands.retain(std::move(asked));
        return answers;
    }
    Buffer ask(const std::vector<TextureQuestion>& questions, bool is_debug = false) {
        Commands commands(context(), "test textures");
        Buffer answers = record_questions(commands, questions, is_debug);
        commands.submit();
        return answers;
    }
    std::vector<TextureAnswer> answers_to(const std::vector<TextureQuestion>& questions, bool is_debug = false) {
        return download<TextureAnswer>(context(), ask(questions, is_debug), questions.size());
    }
    long red_of(TextureRef texture) {
        return std::lround(255 * answers_to({{texture, 0, 0, vec2(0.5f), 0}}).front().texel.x);
    }
    std::uint64_t live_bytes() { return context().allocated_bytes(); }

    faults::FaultInjector injector_;

  private:
    TextureStore* store_ = nullptr;
};
inline std::string name_of_storage(const ::testing::TestParamInfo<TextureStorage>& which) {
    return which.param == TextureStorage::images ? "Images" : "Buffers";
}

}  // namespace twinray::test
