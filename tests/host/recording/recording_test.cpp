#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/navigation/geodetic_pose.h"
#include "host/recording/player.h"
#include "host/recording/recorder.h"
#include "host/recording/recording_scripts.h"
#include "host/recording/session_recording.h"
#include "smooth_ground.h"
#include "support/allocation_count.h"
#include "support/shared_data.h"

namespace meridian::recording {

namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string header(asciiHeader());

std::filesystem::path samples() {
  return test::sharedData("recordings");
}

std::string refusal(const std::string& content) {
  const auto parsed = parseSessionRecording(content, "flight.osrectxt");
  return parsed ? "" : parsed.error().message();
}

CameraEntry cameraAt(double timestamp, const glm::dvec3& position, std::string node = "Root") {
  CameraEntry entry;
  entry.timestamp = timestamp;
  entry.simulationTime = Time(1000.0 + timestamp);
  entry.position = position;
  entry.node = std::move(node);
  return entry;
}

Value staticNode(const char* identifier, const glm::dvec3& position, const glm::dvec3& angles) {
  const Value translation(Table{{}, {{"Type", "StaticTranslation"}, {"Position", Value(position)}}});
  const Value rotation(Table{{}, {{"Type", "StaticRotation"}, {"Rotation", Value(angles)}}});
  return Table{
      {},
      {{"Identifier", identifier}, {"Transform", Table{{}, {{"Translation", translation}, {"Rotation", rotation}}}}}};
}

}  // namespace

TEST(SessionRecording, ReadsTheSamplesOfEveryVersionAndForm) {
  if (!std::filesystem::exists(samples())) {
    GTEST_SKIP() << "NOT CHECKED: no sample recordings in " << samples();
  }
  const auto last = [](const SessionRecording& recording) { return std::get<CameraEntry>(recording.entries.back()); };
  for (const char* name : {"0100_ascii_linux.osrectxt", "0100_binary_linux.osrec"}) {
    const auto recording = readSessionRecording(samples() / name);
    ASSERT_TRUE(recording) << recording.error().message();
    ASSERT_EQ(recording->entries.size(), 6U) << name;
  }
  const auto first = readSessionRecording(samples() / "0100_ascii_linux.osrectxt");
  const auto camera = std::get<CameraEntry>(first->entries[1]);
  EXPECT_EQ(camera.timestamp, 0.0107105);
  EXPECT_EQ(camera.simulationTime.tdbSeconds(), 762933560.412);
  EXPECT_EQ(camera.position.x, -13521714.7579869);
  EXPECT_NEAR(camera.rotation.w, 0.6503710, 1e-6);
  EXPECT_TRUE(camera.followsRotation);
  EXPECT_EQ(camera.node, "Earth");
  EXPECT_EQ(std::get<ScriptEntry>(first->entries[3]).text, "openspace.navigation.flyTo(\"Mars\")");
  for (const char* name : {"0200_ascii_linux.osrectxt", "0300_ascii_linux.osrectxt"}) {
    const auto recording = readSessionRecording(samples() / name);
    ASSERT_TRUE(recording) << recording.error().message();
    ASSERT_EQ(recording->entries.size(), 6U) << name;
    const CameraEntry entry = last(*recording);
    EXPECT_EQ(entry.timestamp, 26.381116207921878) << name;
    EXPECT_NEAR(entry.rotation.w, 0.7107617, 1e-6) << name;
    EXPECT_NEAR(entry.rotation.z, -0.6741872, 1e-6) << name;
    EXPECT_EQ(entry.position.y, 482784744565750824960.0) << name;
    EXPECT_NEAR(entry.scale, 1.7638751e-17, 1e-23) << name;
    EXPECT_FALSE(entry.followsRotation) << name;
    EXPECT_EQ(entry.node, "Venus") << name;
  }
  // The binary samples hold another session, the same in both versions, whose quaternions are ordered differently.
  const auto second = readSessionRecording(samples() / "0200_binary_linux.osrec");
  const auto third = readSessionRecording(samples() / "0300_binary_linux.osrec");
  ASSERT_TRUE(second && third);
  ASSERT_EQ(second->entries.size(), third->entries.size());
  for (std::size_t i = 0; i < second->entries.size(); ++i) {
    ASSERT_EQ(second->entries[i].index(), third->entries[i].index());
    if (const auto* one = std::get_if<CameraEntry>(&second->entries[i])) {
      const auto& other = std::get<CameraEntry>(third->entries[i]);
      EXPECT_EQ(one->rotation, other.rotation);
      EXPECT_EQ(one->position, other.position);
      EXPECT_EQ(one->node, other.node);
      EXPECT_FALSE(other.node.empty());
    } else {
      EXPECT_EQ(std::get<ScriptEntry>(second->entries[i]).text, std::get<ScriptEntry>(third->entries[i]).text);
      EXPECT_THAT(std::get<ScriptEntry>(third->entries[i]).text, HasSubstr("openspace."));
    }
  }
}

TEST(SessionRecording, ToleratesWhatOldWritersAndEditorsLeave) {
  const auto recording = parseSessionRecording(
      "OpenSpace_record/playback01.00A\r\n# a comment\r\n\r\n"
      "time 5.0 0.0 700.5 2.5 P J\r\n"
      "script 5.0 0.5 700  2 print('a')\r\n   print('b')\r\n"
      "camera 5.1\t1.0 701 1 2 3 0 0 0 2 1.0 - Earth",
      "old.osrectxt");
  ASSERT_TRUE(recording) << recording.error().message();
  ASSERT_EQ(recording->entries.size(), 3U);
  EXPECT_THAT(std::get<ScriptEntry>(recording->entries[0]).text, HasSubstr("setPause(true)"));
  EXPECT_THAT(std::get<ScriptEntry>(recording->entries[0]).text, HasSubstr("setTime(700.5)"));
  EXPECT_EQ(std::get<ScriptEntry>(recording->entries[1]).text, "print('a')\nprint('b')");
  EXPECT_EQ(std::get<CameraEntry>(recording->entries[2]).rotation.w, 1.0);
  EXPECT_TRUE(parseSessionRecording("OpenSpace_record/playback03.00A", "x"));
}

TEST(SessionRecording, NamesTheDamagedLineAndWhatIsWrong) {
  const std::string good = "camera 1 2 3 4 5 1 0 0 0 1 F Earth\n";
  const std::pair<std::string, std::vector<std::string>> cases[] = {
      {"", {":1", "session recording"}},
      {"OpenSpace_record/playback09.00A\n", {":1", "09.00"}},
      {"OpenSpace_record/playback03.00X\n", {":1", "'A' or 'B'"}},
      {header + good + "camera 1 2 3 4 five 1 0 0 0 1 F Earth\n", {":3", "position z", "'five'"}},
      {header + good + "camera 1 2 3 4\n", {":3", "position z", "end of the line"}},
      {header + "camera 1 2 3 4 5 nan 0 0 0 1 F Earth\n", {":2", "finite", "'nan'"}},
      {header + "camera 1 2 3 4 5 1e999 0 0 0 1 F Earth\n", {":2", "finite"}},
      {header + "camera 1 2 3 4 5 0 0 0 0 1 F Earth\n", {":2", "length zero"}},
      {header + "camera 1 2 3 4 5 1 0 0 0 1 G Earth\n", {":2", "'F' or '-'", "'G'"}},
      {header + "camera 1 2 3 4 5 1 0 0 0 1 F\n", {":2", "identifier"}},
      {header + "camera 1 2 3 4 5 1 0 0 0 1 F Earth more\n", {":2", "end of the line", "'more'"}},
      {header + good + "camera 0.5 2 3 4 5 1 0 0 0 1 F Earth\n", {":3", "at least 1"}},
      {header + "script 0 0 3 print(1)\n", {":2", "3 lines"}},
      {header + "script 0 0 0 print(1)\n", {":2", "at least 1"}},
      {header + "script 0 0 1e300 print(1)\n", {":2", "end of the file"}},
      {header + "fly me\n", {":2", "'camera', 'script' or 'time'", "'fly'"}},
  };
  for (const auto& [content, parts] : cases) {
    const std::string message = refusal(content);
    for (const std::string& part : parts) {
      EXPECT_THAT(message, HasSubstr(part)) << content;
    }
  }
  EXPECT_FALSE(readSessionRecording("/nowhere/at.all"));
  EXPECT_FALSE(readSessionRecording("/tmp"));
}

TEST(SessionRecording, ABinaryFileCutAnywhereIsRefusedOrShorter) {
  std::ifstream stream(samples() / "0300_binary_linux.osrec", std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (content.empty()) {
    GTEST_SKIP() << "NOT CHECKED: no sample recordings in " << samples();
  }
  int whole = 0;
  for (std::size_t length = 0; length < content.size(); ++length) {
    const auto recording = parseSessionRecording(content.substr(0, length), "cut");
    whole += recording ? 1 : 0;
    if (recording) {
      EXPECT_LT(recording->entries.size(), 6U);
    }
  }
  EXPECT_LE(whole, 8);  // at the ends of entries and of the header
}

TEST(SessionRecording, WhatIsWrittenIsRead) {
  SessionRecording recording;
  CameraEntry camera = cameraAt(0.1, {1.0 / 3.0, -2e20, 3e-7}, "Earth");
  camera.rotation = glm::normalize(glm::dquat(0.1, 0.2, -0.3, 0.4));
  recording.entries = {ScriptEntry{0.0, Time(5.0), "a = 1\nb = 2"}, camera,
                       ScriptEntry{0.2, Time(5.0), "-- note\nprint([[x\ny]])\n"}};
  const auto file = std::filesystem::path(testing::TempDir()) / "meridian_written.osrectxt";
  ASSERT_TRUE(writeSessionRecording(recording, file));
  const auto read = readSessionRecording(file);
  ASSERT_TRUE(read) << read.error().message();
  ASSERT_EQ(read->entries.size(), 3U);
  EXPECT_EQ(std::get<ScriptEntry>(read->entries[0]).text, "a = 1 b = 2");
  EXPECT_EQ(std::get<CameraEntry>(read->entries[1]).position, camera.position);
  EXPECT_LT(glm::length(std::get<CameraEntry>(read->entries[1]).rotation - camera.rotation), 1e-15);
  EXPECT_EQ(std::get<ScriptEntry>(read->entries[2]).text, "-- note\nprint([[x\ny]])");
  std::filesystem::remove(file);
  EXPECT_FALSE(writeSessionRecording(recording, "/nowhere/at.all"));
}

TEST(Player, InterpolatesAboutTheEarlierNodeAndRunsScriptsInOrder) {
  scene::Scene scene;
  ASSERT_TRUE(scene.addNode(staticNode("A", {1e11, 0, 0}, {0.3, 0.5, 0.7}), "test", "/"));
  ASSERT_TRUE(scene.addNode(staticNode("B", {1e11, 1000, 0}, {0, 0, 0}), "test", "/"));
  navigation::Camera camera(scene);
  SessionRecording recording;
  CameraEntry third = cameraAt(4.0, {0, 0, 0}, "B");
  recording.entries = {ScriptEntry{0.0, Time(), "zero"}, cameraAt(1.0, {0, 0, 0}, "A"),
                       ScriptEntry{1.5, Time(), "one"},  ScriptEntry{1.5, Time(), "two"},
                       cameraAt(2.0, {10, 0, 0}, "A"),   third,
                       ScriptEntry{4.0, Time(), "end"}};
  recording.entries[4] = [&] {
    CameraEntry entry = cameraAt(2.0, {10, 0, 0}, "A");
    entry.rotation = glm::angleAxis(1.0, glm::dvec3(0, 0, 1));
    return entry;
  }();
  std::vector<std::string> ran;
  auto player = Player::create(recording, camera, [&](const ScriptEntry& script) -> Result<void> {
    ran.push_back(script.text);
    return script.text == "one" ? Result<void>(failure("on purpose")) : Result<void>();
  });
  ASSERT_TRUE(player);
  EXPECT_EQ(player->startTime().tdbSeconds(), 1001.0);
  const auto inWorldAxes = [&] {
    const scene::Transform world = scene.worldFromNode(camera.anchor());
    return world.rotation * camera.pose().position;
  };
  player->advance(0.0);
  EXPECT_THAT(ran, ElementsAre("zero"));
  EXPECT_EQ(camera.anchor().identifier(), "A");
  player->advance(1.5);
  EXPECT_THAT(ran, ElementsAre("zero"));  // its time must have passed
  EXPECT_LT(glm::distance(inWorldAxes(), glm::dvec3(5, 0, 0)), 1e-12);
  const glm::dquat world = glm::quat_cast(scene.worldFromNode(camera.anchor()).rotation) * camera.pose().rotation;
  EXPECT_NEAR(2.0 * std::atan2(world.z, world.w), 0.5, 1e-12);
  player->advance(0.1);
  EXPECT_THAT(ran, ElementsAre("zero", "one", "two"));
  player->advance(1.4);  // at 3: between A (10, 0, 0) and B, which stands 1000 m off in y
  EXPECT_EQ(camera.anchor().identifier(), "A");
  EXPECT_LT(glm::distance(inWorldAxes(), glm::dvec3(5, 500, 0)), 1e-9);
  EXPECT_FALSE(player->finished());
  player->advance(100.0);
  EXPECT_TRUE(player->finished());
  EXPECT_EQ(camera.anchor().identifier(), "B");
  EXPECT_EQ(ran.back(), "end");
}

TEST(Player, RefusesARecordingThatCannotBegin) {
  scene::Scene scene;
  navigation::Camera camera(scene);
  const auto run = [](const ScriptEntry&) -> Result<void> { return {}; };
  EXPECT_FALSE(Player::create({{ScriptEntry{}}}, camera, run));
  EXPECT_FALSE(Player::create({{cameraAt(0.0, {1, 2, 3}, "Nobody")}}, camera, run));
}

TEST(Recorder, WritesWhatThePlayerPlays) {
  scene::Scene scene;
  ASSERT_TRUE(scene.addNode(staticNode("A", {1e11, 0, 0}, {0.3, 0.5, 0.7}), "test", "/"));
  navigation::Camera camera(scene);
  const navigation::Pose pose{{1.5, 2.5, 1e7}, glm::normalize(glm::dquat(1, 2, 3, 4))};
  ASSERT_TRUE(camera.setPose("A", pose));
  const auto file = std::filesystem::path(testing::TempDir()) / "meridian_recorded.osrectxt";
  auto recorder = Recorder::create(file);
  ASSERT_TRUE(recorder);
  ASSERT_TRUE(recorder->addFrame(0.0, Time(10.0), camera));
  recorder->addScript("return x()", Time(10.0));
  recorder->addScript("openspace.sessionRecording.stopRecording()", Time(10.0));
  ASSERT_TRUE(recorder->addFrame(0.5, Time(10.5), camera));
  ASSERT_TRUE(recorder->finish());
  const auto read = readSessionRecording(file);
  ASSERT_TRUE(read) << read.error().message();
  ASSERT_EQ(read->entries.size(), 3U);
  EXPECT_EQ(std::get<ScriptEntry>(read->entries[1]).text, "x()");
  ASSERT_TRUE(camera.setPose("Root", {}));
  auto player = Player::create(*read, camera, [](const ScriptEntry&) -> Result<void> { return {}; });
  ASSERT_TRUE(player);
  player->advance(0.25);
  EXPECT_EQ(camera.pose().position, pose.position);
  std::filesystem::remove(file);
  EXPECT_FALSE(Recorder::create("/nowhere/at.all"));
}

/// Scripts that record and play, in a scene of one node.
class RecordingScripts : public testing::Test {
 protected:
  RecordingScripts() {
    std::filesystem::remove_all(folder_);
    EXPECT_TRUE(scene_.addNode(staticNode("A", {1e11, 0, 0}, {0, 0, 0}), "test", "/"));
    const auto place = [this](std::string_view path) -> Result<std::filesystem::path> {
      return path.starts_with('/') ? Result<std::filesystem::path>(failure("not there"))
                                   : Result<std::filesystem::path>(folder_ / path);
    };
    engine_.registerLibrary(recordingLibrary(control_, {place, place, folder_ / "progress" / "session.osrectxt"}));
  }
  ~RecordingScripts() override { std::filesystem::remove_all(folder_); }

  std::string run(const std::string& call) {
    const auto done = engine_.run("openspace.sessionRecording." + call, "test.lua");
    return done ? "" : done.error().message();
  }
  bool is(const std::string& question) {
    return engine_.evaluate("openspace.sessionRecording." + question + "()", "test.lua").value().front() == Value(true);
  }
  void frame(double seconds) {
    clock_.advance(seconds);
    scene_.evaluate(clock_.time());
    control_.play(seconds);
    ASSERT_TRUE(control_.record(seconds));
  }
  /// Two seconds along x.
  void recordTwoSeconds() {
    clock_.setTime(Time(1000.0));
    for (int i = 0; i <= 4; ++i) {
      ASSERT_TRUE(camera_.setPose("A", {{100.0 * i, 0, 1e7}, glm::dquat(1, 0, 0, 0)}));
      frame(i == 0 ? 0.0 : 0.5);
    }
  }
  double x() const { return camera_.pose().position.x; }

  std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
  scene::Scene scene_;
  navigation::Camera camera_{scene_};
  scripting::Clock clock_;
  scripting::ScriptEngine engine_;
  SessionControl control_{camera_, clock_, engine_};
};

TEST_F(RecordingScripts, WhatIsRecordedIsPlayed) {
  EXPECT_EQ(run("startRecording()"), "");
  EXPECT_TRUE(is("isRecording"));
  EXPECT_THAT(run("startRecording('b')"), HasSubstr("already"));
  EXPECT_THAT(run("startPlayback('b')"), HasSubstr("already"));
  recordTwoSeconds();
  EXPECT_EQ(run("stopRecording('a.osrectxt', 'Ascii')"), "");
  EXPECT_FALSE(is("isRecording"));
  EXPECT_THAT(run("stopRecording()"), HasSubstr("nothing is recorded"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "a.osrectxt"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "progress/session.osrectxt"));

  clock_.setTime(Time(5000.0));
  EXPECT_EQ(run("startPlayback('a.osrectxt')"), "");
  EXPECT_EQ(clock_.time().tdbSeconds(), 1000.0);
  frame(0.0);
  EXPECT_NEAR(x(), 0.0, 1e-6);
  frame(0.75);
  EXPECT_NEAR(x(), 150.0, 1e-6);
  EXPECT_TRUE(is("isPlayingBack"));
  frame(2.0);
  EXPECT_NEAR(x(), 400.0, 1e-6);
  EXPECT_FALSE(is("isPlayingBack"));
}

TEST_F(RecordingScripts, ConvertsOldVersionsBesideThem) {
  std::filesystem::create_directories(folder_ / "old");
  std::ofstream(folder_ / "old/flight.osrectxt") << "OpenSpace_record/playback01.00A\n"
                                                    "camera 7 0 1000 1 2 3 0 0 0.6 0.8 0.5 F A\n"
                                                    "time 8 1 1001 60 R -\n"
                                                    "script 9 2 1002  1 x()\n";
  EXPECT_EQ(run("fileFormatConversion('old/flight.osrectxt')"), "");
  const auto read = readSessionRecording(folder_ / "old/flight_01.00-03.00.osrectxt");
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->version, "03.00");
  ASSERT_EQ(read->entries.size(), 3U);
  const auto& camera = std::get<CameraEntry>(read->entries[0]);
  EXPECT_EQ(camera.rotation, glm::dquat(0.8, 0, 0, 0.6));
  EXPECT_EQ(camera.node, "A");
  EXPECT_TRUE(camera.followsRotation);
  EXPECT_THAT(std::get<ScriptEntry>(read->entries[1]).text, HasSubstr("setDeltaTime(60)"));
  EXPECT_EQ(std::get<ScriptEntry>(read->entries[2]).text, "x()");
  // A second time that is a file of the present version: nothing to do.
  EXPECT_EQ(run("fileFormatConversion('old/flight_01.00-03.00.osrectxt')"), "");
  const std::filesystem::directory_iterator files(folder_ / "old");
  EXPECT_EQ(std::distance(begin(files), end(files)), 2);
  EXPECT_THAT(run("fileFormatConversion('none')"), HasSubstr("none"));
}

TEST_F(RecordingScripts, PlaybackPausesWithTheTimeAndStops) {
  EXPECT_EQ(run("startRecording('a')"), "");
  recordTwoSeconds();
  EXPECT_EQ(run("stopRecording()"), "");
  EXPECT_EQ(run("startPlayback('a')"), "");
  frame(0.5);
  EXPECT_EQ(run("togglePlaybackPause()"), "");
  const double time = clock_.time().tdbSeconds();
  frame(1.0);
  EXPECT_NEAR(x(), 100.0, 1e-6);
  EXPECT_EQ(clock_.time().tdbSeconds(), time);
  EXPECT_TRUE(is("isPlayingBack"));
  EXPECT_EQ(run("setPlaybackPause(false)"), "");
  frame(0.5);
  EXPECT_NEAR(x(), 200.0, 1e-6);
  EXPECT_FALSE(clock_.isPaused());
  EXPECT_EQ(run("stopPlayback()"), "");
  frame(0.5);
  EXPECT_NEAR(x(), 200.0, 1e-6);
  EXPECT_FALSE(is("isPlayingBack"));
}

TEST_F(RecordingScripts, KnowsWhichLineOfTheRecordingPausedIt) {
  std::filesystem::create_directories(folder_);
  std::ofstream(folder_ / "pausing") << header << "camera 0 1000 0 0 1e7 0 0 0 1 1 - A\n\n"
                                     << "script 0 1000 2 x = 1\n  openspace.sessionRecording.setPlaybackPause(x == 1)\n"
                                     << "script 1 1000 1 error('oops')\ncamera 9 1009 0 0 1e7 0 0 0 1 1 - A\n";
  EXPECT_EQ(run("startPlayback('pausing')"), "");
  frame(0.0);
  EXPECT_TRUE(control_.isPlaybackPaused());
  EXPECT_EQ(control_.pausedBy(), (folder_ / "pausing").string() + ":5");
}

TEST_F(RecordingScripts, LoopsUntilItIsStoppedEvenByItsOwnScript) {
  SessionRecording recording;
  recording.entries = {cameraAt(0.0, {0, 0, 1e7}, "A"), cameraAt(2.0, {200, 0, 1e7}, "A"),
                       ScriptEntry{2.0, Time(),
                                   "rounds = (rounds or 0) + 1 if rounds == 2 then "
                                   "openspace.sessionRecording.stopPlayback() end"}};
  std::filesystem::create_directories(folder_);
  ASSERT_TRUE(writeSessionRecording(recording, folder_ / "loop"));
  EXPECT_EQ(run("startPlayback('loop', true)"), "");
  frame(3.0);
  EXPECT_TRUE(is("isPlayingBack"));
  frame(1.0);
  EXPECT_NEAR(x(), 100.0, 1e-6);
  frame(3.0);
  EXPECT_FALSE(is("isPlayingBack"));
  EXPECT_EQ(engine_.evaluate("rounds", "test.lua").value().front(), Value(2));
}

TEST_F(RecordingScripts, LoopsWithoutTheNodeThatItBeginsAt) {
  EXPECT_TRUE(scene_.addNode(staticNode("B", {1e11, 0, 0}, {0, 0, 0}), "test", "/"));
  SessionRecording recording;
  recording.entries = {cameraAt(0.0, {0, 0, 1e7}, "B"), cameraAt(1.0, {100, 0, 1e7}, "A"),
                       cameraAt(2.0, {200, 0, 1e7}, "A")};
  std::filesystem::create_directories(folder_);
  ASSERT_TRUE(writeSessionRecording(recording, folder_ / "loop"));
  EXPECT_EQ(run("startPlayback('loop', true)"), "");
  frame(2.0);
  ASSERT_TRUE(scene_.removeNode("B"));
  frame(2.0);
  EXPECT_TRUE(is("isPlayingBack"));
  frame(1.5);
  EXPECT_NEAR(x(), 150.0, 1e-6);
}

TEST_F(RecordingScripts, ALoopBeginsAnewWithoutACopyOfTheRecording) {
  SessionRecording recording;
  for (int i = 0; i <= 1000; ++i) {
    recording.entries.emplace_back(cameraAt(0.01 * i, {0, 0, 1e7}, "A"));
    recording.entries.emplace_back(ScriptEntry{0.01 * i, Time(), "-- a script too long for a string without a heap"});
  }
  std::filesystem::create_directories(folder_);
  ASSERT_TRUE(writeSessionRecording(recording, folder_ / "loop"));
  EXPECT_EQ(run("startPlayback('loop', true)"), "");
  frame(20.0);  // runs all scripts, and begins anew
  EXPECT_TRUE(is("isPlayingBack"));
  frame(9.995);
  const std::size_t before = allocationsOfThisThread();
  frame(0.1);
  EXPECT_TRUE(is("isPlayingBack"));
  EXPECT_LT(allocationsOfThisThread() - before, 500U);
}

TEST_F(RecordingScripts, WritesOverNothingUnlessAsked) {
  std::filesystem::create_directories(folder_);
  std::ofstream(folder_ / "there") << "precious";
  EXPECT_EQ(run("startRecording()"), "");
  recordTwoSeconds();
  EXPECT_THAT(run("stopRecording('there', 'Ascii')"), HasSubstr("already"));
  EXPECT_TRUE(is("isRecording")) << "nothing is lost";
  EXPECT_THAT(run("stopRecording('/else', 'Ascii')"), HasSubstr("not there"));
  EXPECT_EQ(run("stopRecording('there', 'Binary', true)"), "");
  EXPECT_TRUE(readSessionRecording(folder_ / "there"));
  EXPECT_EQ(run("startRecording()"), "");
  recordTwoSeconds();
  std::filesystem::create_directories(folder_ / "folder");
  EXPECT_THAT(run("stopRecording('folder', 'Ascii', true)"), HasSubstr("progress/session.osrectxt"));
  EXPECT_TRUE(readSessionRecording(folder_ / "progress/session.osrectxt")) << "nothing is lost";
  EXPECT_THAT(run("startPlayback('missing')"), HasSubstr("no such file"));
  EXPECT_THAT(run("startPlayback(3)"), HasSubstr("must be a string"));
}

TEST(ShippedFlight, GoesFromSpaceLowAlongTheHimalayaAndUpAgain) {
  const auto recording =
      readSessionRecording(std::filesystem::path(MERIDIAN_SOURCE_FOLDER) / "data/flights/earth_descent.osrectxt");
  ASSERT_TRUE(recording) << recording.error().message();
  const test::SmoothGround ground;
  const Time start = *Time::fromUtc("2026-06-21T06:00:00");
  constexpr double degree = std::numbers::pi / 180.0;
  double lowest = 1e9;
  double lowestTime = 0.0;
  std::vector<navigation::GeodeticPose> poses;
  int toggles = 0;
  for (const SessionRecording::Entry& entry : recording->entries) {
    if (const auto* script = std::get_if<ScriptEntry>(&entry)) {
      toggles += script->text.find(".Enabled") != std::string::npos ? 1 : 0;
      continue;
    }
    const auto& camera = std::get<CameraEntry>(entry);
    EXPECT_TRUE(camera.followsRotation);
    EXPECT_EQ(camera.node, "Earth");
    EXPECT_NEAR(camera.simulationTime - start, camera.timestamp, 2e-3);
    poses.push_back(navigation::geodeticFromPose(ground, {camera.position, camera.rotation}));
    if (poses.back().pitch > -85 * degree) {  // straight down the file's nine digits leave no heading or roll
      EXPECT_NEAR(poses.back().roll, 0.0, 1e-6);
    }
    if (poses.back().position.height < lowest) {
      lowest = poses.back().position.height;
      lowestTime = camera.timestamp;
    }
  }
  ASSERT_GT(poses.size(), 500U);
  EXPECT_GE(toggles, 4);
  // The first and the last way-point, as written in the way-point file.
  EXPECT_NEAR(poses.front().position.height, 2e7, 1.0);
  EXPECT_NEAR(poses.front().position.latitude, 12 * degree, 1e-8);
  EXPECT_NEAR(poses.front().position.longitude, 70 * degree, 1e-8);
  EXPECT_NEAR(poses.front().pitch, -90 * degree, 1e-6);
  EXPECT_NEAR(poses.back().heading, -55 * degree, 1e-6);
  EXPECT_NEAR(poses.back().pitch, -12 * degree, 1e-6);
  EXPECT_NEAR(lowest, 8500.0, 1.0);
  EXPECT_NEAR(lowestTime, 47.0, 0.1);
}

}  // namespace meridian::recording
