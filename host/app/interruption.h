#pragma once

namespace meridian::app {

/// From now on SIGINT and SIGTERM only ask the program to end, once; a second one ends it at once.
void listenForInterruption();
[[nodiscard]] bool isInterrupted();

}  // namespace meridian::app
