#pragma once

#include <memory>
#include <vector>

#include "host/api/module.h"
#include "host/app/options.h"

namespace meridian::app {

/// The program behind the command line, from folders to exit code. Every error goes to the log.
[[nodiscard]] ExitCode runProgram(Options options, std::vector<std::unique_ptr<Module>> modules);

}  // namespace meridian::app
