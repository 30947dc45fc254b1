#include "globebrowsing/providers/path_tokens.h"

#include <algorithm>
#include <array>
#include <cctype>

#include <fmt/format.h>

#include "globebrowsing/providers/default_tile_provider.h"
#include "globebrowsing/providers/layer_paths.h"

namespace meridian::globebrowsing {

namespace {

/// Of GDAL's tiled services, of services in time, and of OpenSpace's prototypes.
constexpr std::array<std::string_view, 13> reservedWords{
    "x",      "y",       "z",          "xxx",  "yyy",  "layer",          "version",
    "format", "quadkey", "server_num", "time", "date", "OpenSpaceTimeId"};

struct Token {
  std::size_t begin = 0;  ///< of "${"
  std::size_t end = 0;    ///< after "}"
  std::string_view name;
};

/// The first "${NAME}" from there on.
std::optional<Token> nextToken(std::string_view text, std::size_t from) {
  const std::size_t begin = text.find("${", from);
  const std::size_t end = begin == std::string_view::npos ? begin : text.find('}', begin);
  if (end == std::string_view::npos) {
    return std::nullopt;
  }
  // Of "${a${NAME}" the inner one.
  const std::size_t last = text.rfind("${", end);
  return Token{last, end + 1, text.substr(last + 2, end - last - 2)};
}

bool isInCapitals(std::string_view name) {
  return !name.empty() && std::isupper(static_cast<unsigned char>(name.front())) != 0 &&
         std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return std::isupper(c) != 0 || std::isdigit(c) != 0 || c == '_'; });
}

bool isDocument(std::string_view text) {
  return dataPath(std::string(text), {}).kind == DataPath::Kind::Document;
}

std::string escaped(std::string_view folder) {
  std::string text;
  for (const char c : folder) {
    switch (c) {
      case '&':
        text += "&amp;";
        break;
      case '<':
        text += "&lt;";
        break;
      case '>':
        text += "&gt;";
        break;
      case '"':
        text += "&quot;";
        break;
      default:
        text += c;
    }
  }
  return text;
}

std::string folderText(const std::filesystem::path& folder) {
  std::string text = folder.string();
  while (text.size() > 1 && text.back() == '/') {
    text.pop_back();
  }
  return text;
}

/// Whether the text of an element begins there.
bool beginsElement(std::string_view document, std::size_t at) {
  const std::size_t before = at == 0 ? std::string_view::npos : document.find_last_not_of(" \t\r\n", at - 1);
  return before != std::string_view::npos && document[before] == '>';
}

}  // namespace

std::string withTokensReplaced(const std::string& text, const TokenFolder& folderOf) {
  if (!folderOf || text.find("${") == std::string::npos) {
    return text;
  }
  const bool isXml = isDocument(text);
  std::string replaced;
  std::size_t done = 0;
  for (std::optional<Token> token = nextToken(text, 0); token; token = nextToken(text, token->end)) {
    const bool isReserved = std::find(reservedWords.begin(), reservedWords.end(), token->name) != reservedWords.end();
    const std::optional<std::filesystem::path> folder = isReserved ? std::nullopt : folderOf(token->name);
    if (!folder) {
      continue;
    }
    replaced.append(text, done, token->begin - done);
    replaced += isXml ? escaped(folderText(*folder)) : folderText(*folder);
    done = token->end;
    // "${ASSETS}a.tif" is a file in that folder, too.
    if (token->begin == 0 && done < text.size() && text[done] != '/') {
      replaced += '/';
    }
  }
  return replaced.append(text, done);
}

Value withTokensReplaced(const Value& table, const TokenFolder& folderOf) {
  return folderOf ? withPaths(table, [&](const std::string& path) { return withTokensReplaced(path, folderOf); })
                  : table;
}

Result<void> checkTokens(std::string_view text, const std::string& where) {
  const bool isXml = isDocument(text);
  if (!isXml && text.find("://") != std::string_view::npos) {
    return {};
  }
  for (std::optional<Token> token = nextToken(text, 0); token; token = nextToken(text, token->end)) {
    if (isInCapitals(token->name) && (!isXml || beginsElement(text, token->begin))) {
      return failure(fmt::format("unknown path token ${{{}}}", token->name), where,
                     "check its spelling; openspace.setPathToken makes further ones");
    }
  }
  return {};
}

Error missing(std::string_view what, const std::string& path, const std::string& where, std::string remedy) {
  Result<void> checked = checkTokens(path, where);
  return checked ? Error{fmt::format("{} {} does not exist", what, path), where, std::move(remedy)}
                 : std::move(checked.error());
}

}  // namespace meridian::globebrowsing
