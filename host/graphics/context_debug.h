#pragma once

namespace meridian::graphics {

/// Sends the current context's KHR_debug messages to the log; for the sources of contexts.
void logDebugMessages();

}  // namespace meridian::graphics
