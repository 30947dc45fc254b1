#include "host/assets/file_scripts.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <utility>

#include <fmt/format.h>

#include "host/api/log.h"
#include "host/api/regular_file.h"
#include "host/assets/unpack_zip.h"

namespace meridian::assets {

namespace fs = std::filesystem;

namespace {

using Arguments = std::span<const Value>;

constexpr std::size_t mostEntries = 100'000;
constexpr int deepestLevel = 32;
constexpr std::uintmax_t largestFile = std::uintmax_t{64} << 20;

/// What the functions share: the tokens, and the folder that relative paths begin at.
struct Files {
  PathTokens* tokens;
  std::function<std::string()> folder;
  std::function<void(const fs::path&)> onMissing;

  /// Whether it belongs to data that were to be synchronised and are not there; that is noted.
  [[nodiscard]] bool isNotSynchronised(const fs::path& path) const {
    const fs::path* sync = tokens->find("SYNC");
    std::error_code error;
    if (sync == nullptr || !isBelow(path.lexically_normal(), *sync) || fs::exists(path, error)) {
      return false;
    }
    if (onMissing) {
      onMissing(path);
    }
    return true;
  }

  [[nodiscard]] Result<fs::path> absolute(Arguments arguments) const {
    const std::string* text = arguments[0].string();
    if (text == nullptr || text->find('\0') != std::string::npos) {
      return failure("argument 1 must be a path");
    }
    return tokens->expand(*text).map([this](const fs::path& path) {
      return path.is_absolute() ? path : (fs::path(folder()) / path).lexically_normal();
    });
  }
  [[nodiscard]] Result<fs::path> readable(Arguments arguments) const {
    return absolute(arguments).and_then([this](const fs::path& path) { return tokens->readable(path); });
  }
};

ScriptResult one(Value value) {
  return std::vector<Value>{std::move(value)};
}

bool isTrue(Arguments arguments, std::size_t i, bool otherwise) {
  return i < arguments.size() ? arguments[i].boolean().value_or(otherwise) : otherwise;
}

enum class Wanted { All, Files, Folders };

/// Links to folders are listed but not followed, so a walk neither leaves its folder nor runs in circles.
Result<void> walk(const fs::path& folder, bool recursive, Wanted wanted, int level, std::vector<std::string>& out) {
  if (level > deepestLevel) {
    return failure(fmt::format("the folder is nested deeper than {} levels", deepestLevel), folder.string());
  }
  std::error_code error;
  fs::directory_iterator entries(folder, error);
  for (; !error && entries != fs::directory_iterator(); entries.increment(error)) {
    std::error_code ignored;
    const bool isFolder = entries->is_directory(ignored);
    if (wanted == Wanted::All || (wanted == Wanted::Folders) == isFolder) {
      out.push_back(entries->path().string());
    }
    if (out.size() > mostEntries) {
      return failure(fmt::format("the folder holds more than {} entries", mostEntries), folder.string());
    }
    if (recursive && isFolder && !entries->is_symlink(ignored)) {
      if (Result<void> below = walk(entries->path(), true, wanted, level + 1, out); !below) {
        return below;
      }
    }
  }
  if (error) {
    return failure(fmt::format("the folder cannot be read: {}", error.message()), folder.string());
  }
  return {};
}

ScriptFunction walker(const Files& files, std::string name, Wanted wanted) {
  return {std::move(name),
          "path, recursive?, sorted?",
          "What is in a folder.",
          1,
          3,
          [files, wanted](Arguments a) -> ScriptResult {
            const Result<fs::path> folder = files.readable(a);
            if (!folder) {
              return tl::make_unexpected(folder.error());
            }
            if (files.isNotSynchronised(*folder)) {
              return one(Table{});
            }
            std::vector<std::string> found;
            if (Result<void> done = walk(*folder, isTrue(a, 1, false), wanted, 1, found); !done) {
              return tl::make_unexpected(done.error());
            }
            if (isTrue(a, 2, false)) {
              std::sort(found.begin(), found.end());
            }
            Table table;
            table.list.assign(found.begin(), found.end());
            return one(std::move(table));
          }};
}

/// Outside the folders that may be read nothing exists, as far as scripts can tell.
ScriptFunction tester(const Files& files, std::string name, bool (*test)(const fs::path&, std::error_code&)) {
  return {std::move(name),
          "path",
          "Whether it is there and may be read.",
          1,
          1,
          [files, test](Arguments a) -> ScriptResult {
            const Result<fs::path> path = files.absolute(a);
            if (!path) {
              return tl::make_unexpected(path.error());
            }
            const Result<fs::path> real = files.tokens->readable(*path);
            std::error_code ignored;
            return one(real.has_value() && test(*real, ignored));
          }};
}

Result<std::string> contents(const fs::path& path) {
  return readRegularFile(path, largestFile, "the file", "check the path");
}

/// The file that argument 1 names; empty text for one that was not synchronised.
Result<std::string> contentsAt(const Files& files, Arguments a) {
  return files.readable(a).and_then([&](const fs::path& path) -> Result<std::string> {
    return files.isNotSynchronised(path) ? Result<std::string>("") : contents(path);
  });
}

ScriptResult writeFile(const Files& files, Arguments a) {
  const Result<fs::path> path =
      files.absolute(a).and_then([&](const fs::path& each) { return files.tokens->writable(each); });
  if (!path) {
    return tl::make_unexpected(path.error());
  }
  if (a[1].string() == nullptr) {
    return failure("argument 2 must be a string");
  }
  std::error_code ignored;
  fs::create_directories(path->parent_path(), ignored);
  std::ofstream file(*path, std::ios::binary | std::ios::trunc);
  file << *a[1].string();
  if (!file.flush()) {
    return failure("the file cannot be written", path->string());
  }
  return {};
}

/// A token may only be pointed at what scripts can reach already, or it would open the whole disk.
ScriptResult setPathToken(const Files& files, Arguments a) {
  const std::string* name = a[0].string();
  if (name == nullptr || !name->starts_with("${") || !name->ends_with("}") || name->size() < 4) {
    return failure("argument 1 must be a token like ${NAME}");
  }
  if (a[1].string() == nullptr) {
    return failure("argument 2 must be a path");
  }
  for (const std::string_view fixed : {"${ASSETS}", "${SYNC}", "${CACHE}", "${TEMPORARY}", "${DATA}"}) {
    if (*name == fixed) {
      return failure(fmt::format("{} is the host's and cannot be changed", *name));
    }
  }
  return files.readable(a.subspan(1)).map([&](const fs::path& folder) {
    files.tokens->set(*name, folder);
    return std::vector<Value>();
  });
}

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    if (line.ends_with('\r')) {
      line.pop_back();
    }
    lines.push_back(std::move(line));
  }
  return lines;
}

ScriptResult readFileLines(const Files& files, Arguments a) {
  return contentsAt(files, a).map([](const std::string& text) {
    Table table;
    const std::vector<std::string> lines = linesOf(text);
    table.list.assign(lines.begin(), lines.end());
    return std::vector<Value>{std::move(table)};
  });
}

/// The cells of a line; quotes hold commas, and twice a quote is one.
Table cellsOf(const std::string& line) {
  Table cells;
  std::string cell;
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') {
      cell += line[i++];
    } else if (line[i] == '"') {
      quoted = !quoted;
    } else if (line[i] == ',' && !quoted) {
      cells.list.emplace_back(std::exchange(cell, {}));
    } else {
      cell += line[i];
    }
  }
  cells.list.emplace_back(std::move(cell));
  return cells;
}

/// A list of lines, each a list of cells; the first line is a heading unless it is wanted as well.
ScriptResult readCsvFile(const Files& files, Arguments a) {
  const bool withFirst = isTrue(a, 1, false);
  return contentsAt(files, a).map([&](const std::string& text) {
    Table table;
    const std::vector<std::string> lines = linesOf(text);
    for (std::size_t i = withFirst ? 0 : 1; i < lines.size(); ++i) {
      if (!lines[i].empty()) {
        table.list.emplace_back(cellsOf(lines[i]));
      }
    }
    return std::vector<Value>{std::move(table)};
  });
}

ScriptResult createDirectory(const Files& files, Arguments a) {
  const Result<fs::path> path =
      files.absolute(a).and_then([&](const fs::path& each) { return files.tokens->writable(each); });
  if (!path) {
    // Assets that keep something of their own there can do without.
    log::warning("createDirectory: {}", path.error().message());
    return {};
  }
  std::error_code error;
  fs::create_directories(*path, error);
  if (error) {
    return failure(fmt::format("the folder cannot be made: {}", error.message()), path->string());
  }
  return {};
}

/// A picture of one pixel below ${TEMPORARY}, and its path.
ScriptResult createSingleColourImage(const Files& files, Arguments a) {
  const std::string* name = a[0].string();
  const auto colour = a[1].numbers(3);
  const fs::path* folder = files.tokens->find("TEMPORARY");
  if (name == nullptr || name->empty() || name->find_first_of(std::string_view("/\\\0", 3)) != name->npos || !colour) {
    return failure("the arguments must be a name without slashes and a list of 3 numbers from 0 to 1");
  }
  if (folder == nullptr) {
    return failure("there is no folder ${TEMPORARY}");
  }
  const fs::path file = *folder / (*name + ".ppm");
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  stream << "P6 1 1 255\n";
  for (const double share : *colour) {
    stream.put(static_cast<char>(static_cast<unsigned char>(std::lround(std::clamp(share, 0.0, 1.0) * 255.0))));
  }
  if (!stream.flush()) {
    return failure("the picture cannot be written", file.string());
  }
  return one(file.string());
}

/// What is not there was not synchronised: then there is nothing to unpack, and whoever needs it says so.
ScriptResult unzipFile(const Files& files, Arguments a) {
  const Result<fs::path> archive = files.readable(a);
  const Result<fs::path> folder =
      files.absolute(a.subspan(1)).and_then([&](const fs::path& each) { return files.tokens->writable(each); });
  if (archive && files.isNotSynchronised(*archive)) {
    return {};
  }
  if (!archive || !folder) {
    return tl::make_unexpected(!archive ? archive.error() : folder.error());
  }
  if (auto done = unpackZip(*archive, *folder); !done) {
    return tl::make_unexpected(done.error());
  }
  if (isTrue(a, 2, false) && files.tokens->writable(*archive)) {
    std::error_code error;
    fs::remove(*archive, error);
  }
  return {};
}

ScriptResult makeIdentifier(Arguments a) {
  if (a[0].string() == nullptr) {
    return failure("argument 1 must be a string");
  }
  std::string out = *a[0].string();
  std::replace_if(
      out.begin(), out.end(),
      [](unsigned char c) { return c < 128 && std::isspace(c) == 0 && std::ispunct(c) != 0 && c != '-' && c != '_'; },
      '-');
  std::replace_if(
      out.begin(), out.end(), [](unsigned char c) { return std::isspace(c) != 0; }, '_');
  return one(out);
}

}  // namespace

ScriptLibrary fileLibrary(PathTokens& tokens, std::function<std::string()> folder,
                          std::function<void(const fs::path&)> onMissing) {
  const Files files{&tokens, std::move(folder), std::move(onMissing)};
  const auto absolute = [files](Arguments a) -> ScriptResult {
    return files.absolute(a).map([](const fs::path& path) { return std::vector<Value>{path.string()}; });
  };
  return {
      "",
      {{"absPath", "path", "The whole path, tokens replaced.", 1, 1, absolute},
       {"setPathToken", "token, path", "Names a folder.", 2, 2,
        [files](Arguments a) { return setPathToken(files, a); }},
       tester(files, "fileExists", [](const fs::path& p, std::error_code& e) { return fs::is_regular_file(p, e); }),
       tester(files, "directoryExists", [](const fs::path& p, std::error_code& e) { return fs::is_directory(p, e); }),
       {"directoryForPath", "path", "The folder that holds it.", 1, 1,
        [files](Arguments a) -> ScriptResult {
          return files.absolute(a).map(
              [](const fs::path& path) { return std::vector<Value>{path.parent_path().string()}; });
        }},
       walker(files, "walkDirectory", Wanted::All),
       walker(files, "walkDirectoryFiles", Wanted::Files),
       walker(files, "walkDirectoryFolders", Wanted::Folders),
       {"readFile", "path", "A file's contents.", 1, 1,
        [files](Arguments a) -> ScriptResult {
          return contentsAt(files, a).map([](std::string text) { return std::vector<Value>{std::move(text)}; });
        }},
       {"writeFile", "path, text", "Writes a file below ${SYNC}, ${CACHE} or ${TEMPORARY}.", 2, 2,
        [files](Arguments a) { return writeFile(files, a); }},
       {"readFileLines", "path", "A file's lines.", 1, 1, [files](Arguments a) { return readFileLines(files, a); }},
       {"readCSVFile", "path, first?", "A table's lines, each a list of cells; the first too if so asked.", 1, 2,
        [files](Arguments a) { return readCsvFile(files, a); }},
       {"createDirectory", "path, recursive?", "Makes a folder below ${SYNC}, ${CACHE} or ${TEMPORARY}.", 1, 2,
        [files](Arguments a) { return createDirectory(files, a); }},
       {"createSingleColorImage", "name, colour", "Writes a picture of one colour and gives its path.", 2, 2,
        [files](Arguments a) { return createSingleColourImage(files, a); }},
       {"unzipFile", "archive, folder, delete?", "Unpacks an archive below ${SYNC}, ${CACHE} or ${TEMPORARY}.", 2, 3,
        [files](Arguments a) { return unzipFile(files, a); }},
       {"makeIdentifier", "text", "The text with blanks and punctuation replaced.", 1, 1, makeIdentifier},
       {"version", "", "The program's version.", 0, 0,
        [](Arguments) {
          return one(Table{{},
                           {{"Major", MERIDIAN_VERSION_MAJOR},
                            {"Minor", MERIDIAN_VERSION_MINOR},
                            {"Patch", MERIDIAN_VERSION_PATCH},
                            {"Name", "Meridian"}}});
        }},
       {"layerServer", "", "Which map servers assets should take.", 0, 0, [](Arguments) { return one("All"); }},
       {"dpiScaling", "", "Pixels of the screen for each of a design's.", 0, 0, [](Arguments) { return one(1.0); }}}};
}

ScriptLibrary orbitLibrary(PathTokens& tokens, std::function<std::string()> folder,
                           std::function<void(const fs::path&)> onMissing) {
  const Files files{&tokens, std::move(folder), std::move(onMissing)};
  const auto read = [files](Arguments a) -> ScriptResult {
    return contentsAt(files, a).map([](const std::string&) { return std::vector<Value>{Table{}}; });
  };
  return {"space",
          {{"readKeplerFile", "path, type", "Accepted; orbits are not read.", 2, 2, read},
           {"csvToSpiceTranslation", "path", "Accepted; orbits are not read.", 1, 3, read}}};
}

}  // namespace meridian::assets
