// SPDX-License-Identifier: MIT
#include <sstream>

#include "cli/command/parse.h"
#include "tests/cli/sample_command.h"
#include "tests/fuzz/contract.h"

namespace twinray::fuzz {

// A word a line.
void command(Input input) {
    std::istringstream lines(std::string(input.begin(), input.end()));
    std::vector<std::string> words;
    for (std::string line; std::getline(lines, line);) words.push_back(line);
    cli::SampleValues values;
    try {
        parse(cli::sample_command(values), words);
        require(values.count >= 1 && values.count <= 9, "a number keeps to its limits");
    } catch (const cli::UsageError& error) {
        require(error.what()[0] != '\0', "a refusal says what is wrong");
    }
}

}  // namespace twinray::fuzz
