// SPDX-License-Identifier: MIT
#include "cli/suite/controls.h"

#include "control_without_precise.spv.h"

namespace twinray::suite {

Control without_precise() {
    return {{.name = "control: without precise",
             .software = control_without_precise_spirv,
             .ray_query = {},
             .any_hit = {},
             .intersection = {}},
            false};
}

}  // namespace twinray::suite
