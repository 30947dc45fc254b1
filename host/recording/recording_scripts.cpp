#include "host/recording/recording_scripts.h"

#include <string>
#include <system_error>
#include <utility>

#include "host/api/log.h"
#include "host/recording/move_file.h"
#include "host/recording/session_recording.h"

namespace meridian::recording {

namespace {

namespace fs = std::filesystem;
using Arguments = std::span<const Value>;

ScriptResult none(const Result<void>& done) {
  return done ? ScriptResult(std::vector<Value>{}) : tl::make_unexpected(done.error());
}

Result<std::string> textAt(Arguments arguments, std::size_t place) {
  if (place < arguments.size() && arguments[place].string() != nullptr) {
    return *arguments[place].string();
  }
  return failure("argument " + std::to_string(place + 1) + " must be a string");
}

/// False where it is left out.
bool flagAt(Arguments arguments, std::size_t place) {
  return place < arguments.size() && arguments[place].boolean().value_or(false);
}

Result<void> makeFolderOf(const fs::path& file) {
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  return error ? Result<void>(failure("the folder cannot be made: " + error.message(), file.string())) : Result<void>{};
}

Result<void> startRecording(SessionControl& control, const RecordingPaths& paths, Arguments arguments) {
  Result<fs::path> file = paths.inProgress;
  if (!arguments.empty()) {
    file = textAt(arguments, 0).and_then(paths.writable);
  }
  return file.and_then([&](const fs::path& whole) {
    return makeFolderOf(whole).and_then([&] { return control.startRecording(whole); });
  });
}

/// With a path the recording is put there.
Result<void> stopRecording(SessionControl& control, const RecordingPaths& paths, Arguments arguments) {
  if (arguments.empty()) {
    return control.stopRecording();
  }
  const Result<fs::path> file = textAt(arguments, 0).and_then(paths.writable);
  if (!file) {
    return tl::make_unexpected(file.error());
  }
  if (arguments.size() > 1 && arguments[1] == Value("Binary")) {
    log::info("{}: recordings are written as ASCII, which is read like the others", file->string());
  }
  std::error_code ignored;
  const bool isSame = *file == control.recordingFile();
  if (!isSame && !flagAt(arguments, 2) && fs::exists(*file, ignored)) {
    return failure("there is such a file already", file->string(), "name another one, or true as third argument");
  }
  return makeFolderOf(*file).and_then([&] { return control.stopRecording(); }).and_then([&] {
    return isSame ? Result<void>{} : moveFile(control.recordingFile(), *file);
  });
}

/// A copy of the present version beside the file, named after both versions as OpenSpace names it.
Result<void> convertRecording(const RecordingPaths& paths, Arguments arguments) {
  const Result<std::string> name = textAt(arguments, 0);
  const Result<fs::path> file = name.and_then(paths.readable);
  if (!file) {
    return tl::make_unexpected(file.error());
  }
  const auto recording = readSessionRecording(*file);
  if (!recording) {
    return tl::make_unexpected(recording.error());
  }
  const std::string present = SessionRecording{}.version;
  if (recording->version == present) {
    log::info("{}: the recording is of version {} already", file->string(), present);
    return {};
  }
  fs::path copy(*name);
  copy.replace_filename(copy.stem().string() + '_' + recording->version + '-' + present + ".osrectxt");
  return paths.writable(copy.string()).and_then([&](const fs::path& whole) {
    return makeFolderOf(whole).and_then([&] { return writeSessionRecording(*recording, whole); }).map([&] {
      log::info("{}: converted from version {} to {}", whole.string(), recording->version, present);
    });
  });
}

ScriptFunction playback(SessionControl& control, const RecordingPaths& paths, std::string name) {
  return {std::move(name),
          "file, loop?, waitForTiles?, framesPerSecond?",
          "Plays a recording.",
          1,
          4,
          [&control, paths](Arguments arguments) {
            return none(textAt(arguments, 0).and_then(paths.readable).and_then([&](const fs::path& file) {
              return control.startPlayback(file, flagAt(arguments, 1));
            }));
          }};
}

}  // namespace

ScriptLibrary recordingLibrary(SessionControl& control, const RecordingPaths& paths) {
  ScriptLibrary library{"sessionRecording", {}};
  const auto add = [&](std::string name, std::string arguments, std::string description, std::size_t least,
                       std::size_t most, std::function<ScriptResult(Arguments)> call) {
    library.functions.push_back(
        {std::move(name), std::move(arguments), std::move(description), least, most, std::move(call)});
  };
  const auto start = [&control, paths](Arguments a) { return none(startRecording(control, paths, a)); };
  add("startRecording", "file?", "Records the session; without a file stopRecording names it.", 0, 1, start);
  add("startRecordingAscii", "file", "As startRecording.", 1, 1, start);
  add("stopRecording", "file?, format?, overwrite?", "Ends the recording and puts it there.", 0, 3,
      [&control, paths](Arguments a) { return none(stopRecording(control, paths, a)); });
  add("fileFormatConversion", "file", "Writes a copy of the present version beside a recording.", 1, 1,
      [paths](Arguments a) { return none(convertRecording(paths, a)); });
  for (const char* name :
       {"startPlayback", "startPlaybackApplicationTime", "startPlaybackRecordedTime", "startPlaybackSimulationTime"}) {
    library.functions.push_back(playback(control, paths, name));
  }
  add("stopPlayback", "", "Ends the playback.", 0, 0, [&control](Arguments) {
    control.stopPlayback();
    return none({});
  });
  add("setPlaybackPause", "paused", "Pauses the playback and the time, or goes on.", 1, 1, [&control](Arguments a) {
    control.setPlaybackPause(flagAt(a, 0));
    return none({});
  });
  add("togglePlaybackPause", "", "Pauses the playback and the time, or goes on.", 0, 0, [&control](Arguments) {
    control.setPlaybackPause(!control.isPlaybackPaused());
    return none({});
  });
  add("isPlayingBack", "", "Whether a recording is played, paused or not.", 0, 0,
      [&control](Arguments) -> ScriptResult { return std::vector<Value>{control.isPlaying()}; });
  add("isRecording", "", "Whether the session is recorded.", 0, 0,
      [&control](Arguments) -> ScriptResult { return std::vector<Value>{control.isRecording()}; });
  return library;
}

}  // namespace meridian::recording
