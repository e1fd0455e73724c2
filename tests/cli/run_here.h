#pragma once

#include "tests/cli/command_fixture.h"

namespace mimetra::test {

/// Whether `arguments` need neither a shell nor a part of the command that is not linked here:
/// pictures, VTK and the command's own operations.
bool can_run_here(const std::string& arguments);

/// What the command would answer to `arguments` in `folder`. Runs them in this process: with
/// sanitizers the command takes longer to start than most operations run.
CommandResult run_here(const std::filesystem::path& folder, const std::string& arguments);

/// Starts the command only for arguments that cannot run here. A test that compares bytes must run
/// all that it compares in one way, as the compiler's options differ.
class QuickCommandTest : public CommandTest {
 protected:
  CommandResult run(const std::string& arguments, const std::string& prefix = "") const {
    if (prefix.empty() && can_run_here(arguments)) return run_here(folder_, arguments);
    return CommandTest::run(arguments, prefix);
  }
};

}  // namespace mimetra::test
