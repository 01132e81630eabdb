#include <span>
#include <vector>

#include <twinray/scene.h>
#include <twinray/sets.h>

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "tests/docs/wraps/materials.h"
#include "twinray/glsl/cpp_end.h"
}  // namespace twinray

using namespace twinray;

// Names that lines about sets, textures and queues use.
void lines_of_a_page(Context& context, Commands& commands, TWINRAY_MULTI_TYPE_SET(MaterialSet, MATERIALS) & materials,
                     TextureStore& textures, TextureRef texture, const Image& image, const std::vector<float>& values,
                     const Kernel<PaintArgs>& kernel, uint count) {
    { BLOCK }
}
