// SPDX-License-Identifier: MIT
// What shells do with the scripts: cli_command_test.py.
#include "cli/command/completion.h"

#include <gtest/gtest.h>

#include "tests/cli/sample_command.h"

namespace twinray::cli {
namespace {

TEST(Completion, EachScriptNamesCommandsOptionsAndChoices) {
    SampleValues values;
    const std::vector<Command> commands = {sample_command(values)};
    for (const std::string& script : {bash_completion(commands), zsh_completion(commands), fish_completion(commands)}) {
        EXPECT_TRUE(has(script, "probe")) << script;
        EXPECT_TRUE(has(script, "auto sw hw")) << script;
        EXPECT_TRUE(has(script, "within")) << script;
        EXPECT_FALSE(has(script, "--rays")) << "former names are not shown\n" << script;
    }
}

TEST(Completion, HelpsAreCutWhereDetailsBegin) {
    SampleValues values;
    const std::vector<Command> commands = {sample_command(values)};
    EXPECT_TRUE(has(fish_completion(commands), "-l quiet -d 'say nothing'\n"));
    EXPECT_TRUE(has(zsh_completion(commands), "'--quiet[say nothing]'"));
}

}  // namespace
}  // namespace twinray::cli
