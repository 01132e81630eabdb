// SPDX-License-Identifier: MIT
#include "report/suite/controls.h"

#include "control_contracted.spv.h"
#include "control_without_padding.spv.h"
#include "control_without_precise.spv.h"

namespace twinray::suite {

Control without_precise() {
    Control control{{}, false};
    control.code.name = "control: without precise";
    control.code.software = control_without_precise_spirv;
    return control;
}

Control contracted() {
    Control control{{}, true};
    control.code.name = "control: contracted";
    control.code.software = control_contracted_spirv;
    return control;
}

Control without_padding() {
    Control control{{}, true, 0.01};
    control.code.name = "control: without padding";
    control.layout = Layout::bvh2;
    control.code.software = control_without_padding_spirv;
    return control;
}

}  // namespace twinray::suite
