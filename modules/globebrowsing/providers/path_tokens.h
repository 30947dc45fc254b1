#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "host/api/error.h"
#include "host/api/value.h"

namespace meridian::globebrowsing {

/// The folder that a path token stands for, by its name alone ("ASSETS"); nothing for a name that is none. For the
/// render thread.
using TokenFolder = std::function<std::optional<std::filesystem::path>(std::string_view name)>;

/// The text with the folders in place of its tokens, such as ${ASSETS}, wherever they stand; in an XML document with
/// what that needs escaped. The words that belong to addresses and to GDAL, such as ${x} and ${OpenSpaceTimeId}, stay,
/// and so does what is no token.
[[nodiscard]] std::string withTokensReplaced(const std::string& text, const TokenFolder& folderOf);
/// A layer's table with that done to all of its paths, as withPaths finds them. Unchanged without `folderOf`.
[[nodiscard]] Value withTokensReplaced(const Value& table, const TokenFolder& folderOf);

/// The error of a path in which there still is a token by the looks of it, in capitals: nothing knows it. In an XML
/// document only where an element's text begins with it; never in a web address, whose server may mean something by it.
[[nodiscard]] Result<void> checkTokens(std::string_view text, const std::string& where);

/// The error of a path at which nothing is: that of its token, or else "WHAT PATH does not exist" with the remedy.
[[nodiscard]] Error missing(std::string_view what, const std::string& path, const std::string& where,
                            std::string remedy);

}  // namespace meridian::globebrowsing
