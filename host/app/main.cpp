#include <cstdio>
#include <utility>
#include <variant>

#include "host/app/module_list.h"
#include "host/app/options.h"
#include "host/app/program.h"

int main(int count, char** arguments) {
  using namespace meridian::app;
  auto parsed = parseOptions({arguments + 1, arguments + (count > 0 ? count : 1)});
  if (const auto* exit = std::get_if<EarlyExit>(&parsed)) {
    std::fputs(exit->text.c_str(), exit->code == ExitCode::Done ? stdout : stderr);
    return static_cast<int>(exit->code);
  }
  return static_cast<int>(runProgram(std::move(std::get<Options>(parsed)), makeModules()));
}
