#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <sys/wait.h>

namespace meridian::app {

namespace fs = std::filesystem;
struct Outcome {
  int code = -1;  ///< 128 + signal when one ended it
  std::string out;
  std::string errors;
};

inline std::string readFile(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The program as a user runs it, in a folder of its own.
class CommandLine : public ::testing::Test {
 protected:
  CommandLine() {
    std::string path = (fs::temp_directory_path() / "meridian-cli-XXXXXX").string();
    folder_ = mkdtemp(path.data());
  }
  ~CommandLine() override { fs::remove_all(folder_); }

  fs::path in(const std::string& name) const { return folder_ / name; }

  fs::path write(const std::string& name, const std::string& text) const {
    fs::create_directories(in(name).parent_path());
    std::ofstream(in(name)) << text;
    return in(name);
  }

  /// An asset of one node that shows nothing.
  fs::path emptyScene() const {
    return write("empty.asset", R"(
      local node = { Identifier = "Place", BoundingSphere = 1000.0 }
      asset.onInitialize(function() openspace.addSceneGraphNode(node) end)
      asset.onDeinitialize(function() openspace.removeSceneGraphNode(node) end)
    )");
  }

  /// `arguments` as typed in a shell; without any display. `prefix`: environment and such. In the foreground, because
  /// otherwise `timeout` passes a signal on twice, and the second kills at once.
  Outcome run(const std::string& arguments, const std::string& prefix = "") const {
    const std::string command = "cd '" + folder_.string() + "' && env -u DISPLAY -u WAYLAND_DISPLAY " + prefix +
                                " timeout --foreground 60 '" MERIDIAN_PROGRAM "' " + arguments +
                                " >out.txt 2>errors.txt";
    const int status = std::system(command.c_str());
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return {code, readFile(in("out.txt")), readFile(in("errors.txt"))};
  }

  fs::path folder_;
};

}  // namespace meridian::app
