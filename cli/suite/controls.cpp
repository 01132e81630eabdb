// SPDX-License-Identifier: MIT
#include "cli/suite/controls.h"

#include "control_without_precise.spv.h"

namespace twinray::suite {

Control without_precise() {
    Control control{{}, false};
    control.code.name = "control: without precise";
    control.code.software = control_without_precise_spirv;
    return control;
}

}  // namespace twinray::suite
