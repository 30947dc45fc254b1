// The program as a user runs it: arguments in, exit code, messages and files out.
#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include "cli_fixture.h"
#include "host/graphics/image.h"

namespace meridian::app {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(CommandLine, HelpGoesToStandardOutput) {
  const Outcome outcome = run("--help");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, HasSubstr("--headless"));
  EXPECT_EQ(outcome.errors, "");
}

TEST_F(CommandLine, VersionIsPrinted) {
  const Outcome outcome = run("--version");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, HasSubstr("meridian "));
}

TEST_F(CommandLine, WrongUsageEndsWithTwoAndOneLine) {
  for (const char* arguments : {"--nonsense", "--size 0x0 --headless", "--headless --output picture.bmp",
                                "--set A.B=[[unfinished", "--set A.B=word", "--set 'A.B=function() end'"}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
    EXPECT_EQ(outcome.out, "");
  }
}

TEST_F(CommandLine, ASceneWithoutGlobesIsABlackPictureOfTheRightSize) {
  emptyScene();
  const Outcome outcome = run("empty.asset --headless --size 320x200 --output picture.png --stats stats.json");
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  const auto image = meridian::graphics::readPng(in("picture.png"));
  ASSERT_TRUE(image) << image.error().message();
  EXPECT_EQ(image->size, glm::ivec2(320, 200));
  for (std::size_t i = 0; i < image->pixels.size(); i += 4) {
    ASSERT_EQ(image->pixels[i] + image->pixels[i + 1] + image->pixels[i + 2], 0) << "at " << i / 4;
  }
  const auto stats = nlohmann::json::parse(readFile(in("stats.json")));
  EXPECT_EQ(stats["frames"], 1);
  EXPECT_GT(stats["frame_ms"]["median"], 0.0);
  EXPECT_GT(stats["memory"]["peak_rss"], 1'000'000);
}

TEST_F(CommandLine, FramesGoIntoAFolderAndAVideo) {
  emptyScene();
  const Outcome folder = run("empty.asset --headless --size 64x64 --frames 3 --fps 25 --output frames --settle 1");
  ASSERT_EQ(folder.code, 0) << folder.errors;
  EXPECT_TRUE(fs::exists(in("frames/frame_000002.png")));
  EXPECT_FALSE(fs::exists(in("frames/frame_000003.png")));
  const Outcome video = run("empty.asset --headless --size 64x64 --frames 3 --output video.mkv");
  ASSERT_EQ(video.code, 0) << video.errors;
  EXPECT_GT(fs::file_size(in("video.mkv")), 100U);
}

TEST_F(CommandLine, OutputThatCannotBeWrittenFailsBeforeDrawing) {
  emptyScene();
  write("file", "x");
  const Outcome outcome = run("empty.asset --headless --output file/below/picture.png");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.errors, HasSubstr("file/below"));
}

TEST_F(CommandLine, StatsThatCannotBeWrittenFail) {
  emptyScene();
  write("file", "x");
  // Before the run, not after it: this one would take its time.
  const Outcome outcome = run("empty.asset --headless --size 8x8 --frames 1000000 --stats file/stats.json");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.errors, HasSubstr("file/stats.json"));
  EXPECT_EQ(run("empty.asset --headless --size 8x8 --stats new/folder/stats.json").code, 0);
  EXPECT_TRUE(fs::exists(in("new/folder/stats.json")));
}

TEST_F(CommandLine, PicturesOffScreenWaitForTheirDataUnlessTold) {
  emptyScene();
  const auto framesSettled = [&](const std::string& arguments) {
    EXPECT_EQ(run("empty.asset --headless --size 8x8 --stats s.json " + arguments).code, 0) << arguments;
    return nlohmann::json::parse(readFile(in("s.json")))["settled"]["frames_settled"].get<int>();
  };
  EXPECT_EQ(framesSettled("--output a.png"), 1);
  EXPECT_EQ(framesSettled("--output a.png --settle 0"), 0);
  EXPECT_EQ(framesSettled(""), 0);
  EXPECT_EQ(framesSettled("--settle 5"), 1);
}

TEST_F(CommandLine, ACameraOfARecordingThatCannotBeUsedIsToldOnceWithItsLine) {
  emptyScene();
  const std::string rest = " 0 0 0 1 0 0 0 1 F ";
  write("gone.osrectxt", "OpenSpace_record/playback03.00A\ncamera 0 0" + rest + "Place\ncamera 1 1" + rest +
                             "Nowhere\ncamera 2 2" + rest + "Place\n");
  const Outcome gone = run("empty.asset --headless --size 8x8 --play gone.osrectxt --fps 20");
  EXPECT_EQ(gone.code, 0);
  EXPECT_THAT(gone.errors, HasSubstr("line 3) is relative to 'Nowhere', which is not in the scene"));
  EXPECT_EQ(gone.errors.find("Nowhere"), gone.errors.rfind("Nowhere")) << gone.errors;
  write("far.osrectxt", "OpenSpace_record/playback03.00A\ncamera 0 0" + rest + "Place\ncamera 1 1 1e300" +
                            rest.substr(2) + "Place\ncamera 2 2" + rest + "Place\n");
  const Outcome far = run("empty.asset --headless --size 8x8 --play far.osrectxt --fps 20");
  EXPECT_THAT(far.errors, HasSubstr("line 3) cannot be used"));
  EXPECT_EQ(far.errors.find("cannot be used"), far.errors.rfind("cannot be used")) << far.errors;
}

TEST_F(CommandLine, BadAssetsFailWithTheirPlace) {
  write("syntax.asset", "local a = \n\n = 3\n");
  write("endless.asset", "while true do end\n");
  fs::create_directories(in("folder.asset"));
  const std::pair<const char*, const char*> cases[] = {
      {"missing.asset", "missing.asset"},
      {"syntax.asset", "syntax.asset:3"},
      {"endless.asset", "endless.asset:1"},
      {"folder.asset", "folder.asset"},
  };
  for (const auto& [asset, says] : cases) {
    const Outcome shown = run(std::string(asset) + " --headless --size 8x8 --output picture.png");
    EXPECT_EQ(shown.code, 1) << asset;
    EXPECT_THAT(shown.errors, HasSubstr(says));
    EXPECT_FALSE(fs::exists(in("picture.png"))) << asset;
  }
}

TEST_F(CommandLine, ABadAssetDoesNotTakeTheOthersDown) {
  emptyScene();
  write("syntax.asset", "local = 3\n");
  const Outcome outcome = run("syntax.asset empty.asset --headless --size 8x8 --output picture.png");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_TRUE(fs::exists(in("picture.png")));
}

TEST_F(CommandLine, AnAssetThatFailedIsReloadedWholly) {
  write("globe.asset", R"(
    local globe = { Identifier = "Globe", Renderable = { Type = "RenderableGlobe", Radii = 6e6 } }
    asset.onInitialize(function() openspace.addSceneGraphNode(globe) end)
    asset.onDeinitialize(function() openspace.removeSceneGraphNode(globe) end)
  )");
  const bool hasGlobes = run("--validate globe.asset").out.find("globes 1") != std::string::npos;
  write("parts.asset", R"(
    asset.onInitialize(function()
      openspace.action.registerAction({ Identifier = "hello", Command = "" })
      openspace.bindKey(isMended and "F6" or "F5", "hello")
      if openspace.hasSceneGraphNode("Globe") then
        openspace.globebrowsing.addLayer("Globe", "ColorLayers", { Identifier = isMended and "Good" or "Bad",
          Type = "SolidColor", Color = { 1, 1, 1 } })
      end
      assert(isMended, "not mended")
    end)
  )");
  write("mend.lua", R"(
    isMended = true
    openspace.asset.reload("parts.asset")
    openspace.printInfo("keys " .. table.concat(openspace.keyBindingsForAction("hello"), " "))
    if openspace.hasSceneGraphNode("Globe") then
      openspace.printInfo("layers " .. table.concat(openspace.globebrowsing.layers("Globe", "ColorLayers"), " "))
    end
  )");
  emptyScene();
  const Outcome outcome = run(std::string(hasGlobes ? "globe.asset" : "empty.asset") +
                              " parts.asset --headless --size 8x8 --script mend.lua --output picture.png");
  EXPECT_EQ(outcome.code, 1) << "it had failed";
  EXPECT_THAT(outcome.errors, HasSubstr("not mended"));
  EXPECT_TRUE(fs::exists(in("picture.png"))) << outcome.errors;
  EXPECT_THAT(outcome.errors, HasSubstr("keys F6\n"));
  if (hasGlobes) {
    EXPECT_THAT(outcome.errors, HasSubstr("layers Good\n"));
  }
}

TEST_F(CommandLine, ShowsProfiles) {
  write("data/assets/base.asset", R"(
    local node = { Identifier = "Place", BoundingSphere = 1000.0 }
    asset.onInitialize(function() openspace.addSceneGraphNode(node) end)
  )");
  const std::string profile = R"json({ "version": { "major": 1, "minor": 5 }, "assets": [ "base", "missing" ],
    "camera": { "type": "goToNode", "anchor": "Place", "height": 500 },
    "time": { "type": "absolute", "value": "2020 JAN 02 03:04:05", "is_paused": true },
    "properties": [ { "type": "setPropertyValueSingle", "name": "RenderEngine.VerticalSync", "value": "false" } ],
    "mark_nodes": [ "Place" ],
    "actions": [ { "identifier": "hello", "name": "", "documentation": "", "gui_path": "", "is_local": false,
                   "script": "openspace.printInfo('hello from an action')"
} ],
    "keybindings": [ { "key": "Ctrl+H", "action": "hello" } ],
    "modules": [ { "name": "Nothing", "loadedInstruction": "error('loaded')",
                   "notLoadedInstruction": "openspace.printInfo('not loaded')" } ],
    "additional_scripts": [ "openspace.action.triggerAction('hello')",
      "openspace.printInfo(openspace.time.UTC() .. ' ' .. tostring(openspace.time.isPaused()))",
      "openspace.printInfo('far ' .. openspace.navigation.distanceToFocus())",
      "openspace.printInfo('sync ' .. tostring(openspace.propertyValue('RenderEngine.VerticalSync')))",
      "openspace.printInfo(openspace.keyBindings('Ctrl+H')[1])" ])json";
  write("data/profiles/p.profile", profile + "}");
  const Outcome outcome = run("data/profiles/p.profile --headless --size 8x8 --output picture.png");
  EXPECT_EQ(outcome.code, 1) << "an asset is missing";
  EXPECT_TRUE(fs::exists(in("picture.png"))) << outcome.errors;
  for (const char* line : {"data/assets/missing.asset", "2020-01-02T03:04:05.000 true", "far 1500", "sync false",
                           "info hello", "not loaded", "hello from an action"}) {
    EXPECT_THAT(outcome.errors, HasSubstr(line));
  }
  write("data/profiles/bad.profile", profile + R"(, "nodes": [] })");
  const Outcome bad = run("data/profiles/bad.profile --headless --size 8x8 --output no.png");
  EXPECT_EQ(bad.code, 1);
  EXPECT_THAT(bad.errors, HasSubstr("bad.profile: nodes: unknown key nodes"));
  EXPECT_FALSE(fs::exists(in("no.png")));
  const Outcome checked = run("--validate data/profiles/p.profile");
  EXPECT_EQ(checked.code, 3);
  EXPECT_EQ(checked.out, "assets 1 ok 1 failed; globes 0; layers 0 usable 0\n");
}

TEST_F(CommandLine, RefusesPicturesThatAreTooLarge) {
  const Outcome outcome = run("--headless --size 16384x16384 --output picture.png");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("million pixels"));
}

TEST_F(CommandLine, WithoutADisplayItSaysSo) {
  emptyScene();
  const Outcome window = run("empty.asset");
  EXPECT_EQ(window.code, 1);
  EXPECT_THAT(window.errors, HasSubstr("--headless"));
  const Outcome fallback = run("empty.asset --size 8x8 --output picture.png");
  EXPECT_EQ(fallback.code, 0) << fallback.errors;
  EXPECT_THAT(fallback.errors, HasSubstr("off screen"));
  EXPECT_TRUE(fs::exists(in("picture.png")));
}

TEST_F(CommandLine, AnOpenGLThatIsTooOldIsNamed) {
  emptyScene();
  const Outcome outcome = run("empty.asset --headless --size 8x8 --output picture.png", "MESA_GL_VERSION_OVERRIDE=3.3");
  EXPECT_EQ(outcome.code, 1);
  for (const char* part : {"OpenGL 4.5 core is needed", "found 3.3", "install a driver"}) {
    EXPECT_THAT(outcome.errors, HasSubstr(part));
  }
  EXPECT_FALSE(fs::exists(in("picture.png")));
}

TEST_F(CommandLine, SettingsAndScriptsReachTheScene) {
  emptyScene();
  write("check.lua", R"(
    openspace.printInfo("samples " .. openspace.propertyValue("RenderEngine.Antialiasing"))
    openspace.printInfo("time " .. openspace.time.UTC())
  )");
  const Outcome outcome =
      run("empty.asset --headless --size 8x8 --frames 2 --time 2026-03-20T14:46:00 --set RenderEngine.Antialiasing=4 "
          "--script check.lua --output picture.png");
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_THAT(outcome.errors, HasSubstr("samples 4"));
  EXPECT_THAT(outcome.errors, HasSubstr("2026-03-20T14:46:00"));
}

TEST_F(CommandLine, ScriptsThatWaitHaveGoneOnBeforeThePictureAndTheEnd) {
  emptyScene();
  write("capabilities.xml",
        "<WMS_Capabilities version='1.3.0'><Capability><Request><GetMap><Format>image/png</Format><DCPType><HTTP><Get>"
        "<OnlineResource xmlns:xlink='http://www.w3.org/1999/xlink' xlink:href='http://localhost:1/'/></Get></HTTP>"
        "</DCPType></GetMap></Request><Layer><Layer><Name>ice</Name><CRS>EPSG:4326</CRS><EX_GeographicBoundingBox>"
        "<westBoundLongitude>-180</westBoundLongitude><eastBoundLongitude>180</eastBoundLongitude>"
        "<southBoundLatitude>-90</southBoundLatitude><northBoundLatitude>90</northBoundLatitude>"
        "</EX_GeographicBoundingBox></Layer></Layer></Capability></WMS_Capabilities>");
  const std::string load = "openspace.globebrowsing.loadWMSCapabilities('s', 'Earth', '" +
                           in("capabilities.xml").string() + "')\n" +
                           "openspace.printInfo('offered ' .. #openspace.globebrowsing.capabilitiesWMS('s'))\n";
  write("load.lua", load);
  write("fail.lua", load + "error('too late')\n");
  for (const char* arguments : {"", "--frames 1 --settle 0", "--output picture.png"}) {
    const Outcome outcome = run(std::string("empty.asset --headless --size 8x8 --script load.lua ") + arguments);
    EXPECT_EQ(outcome.code, 0) << arguments;
    EXPECT_THAT(outcome.errors, HasSubstr("offered 1")) << arguments;
    EXPECT_THAT(outcome.errors, Not(HasSubstr("not complete"))) << arguments;
  }
  const Outcome failed = run("empty.asset --headless --size 8x8 --frames 3 --script fail.lua");
  EXPECT_EQ(failed.code, 1);
  EXPECT_THAT(failed.errors, HasSubstr("too late"));
}

TEST_F(CommandLine, WhatTheSceneRefusesFails) {
  emptyScene();
  write("bad.lua", "error('oops')\n");
  ASSERT_EQ(mkfifo(in("pipe").c_str(), 0600), 0);  // nobody ever writes to it
  for (const char* arguments :
       {"--set No.Such.Property=1", "--set RenderEngine.Antialiasing=99", "--anchor Nowhere", "--camera 0,0,1000",
        "--script missing.lua", "--script bad.lua", "--script /dev/zero", "--script pipe", "--play pipe",
        "--play missing.osrec", "--record missing/folder/r.osrectxt"}) {
    const Outcome outcome = run(std::string("empty.asset --headless --size 8x8 ") + arguments);
    EXPECT_EQ(outcome.code, 1) << arguments;
    EXPECT_NE(outcome.errors, "") << arguments;
  }
}

TEST_F(CommandLine, ARecordingIsPlayedToItsEnd) {
  emptyScene();
  write("flight.osrectxt",
        "OpenSpace_record/playback03.00A\n"
        "camera 0.0 0.0 0.0 0.0 5000.0 0.0 0.0 0.0 1.0 1.0 - Place\n"
        "camera 0.5 0.5 0.0 0.0 3000.0 0.0 0.0 0.0 1.0 1.0 - Place\n");
  const Outcome outcome = run("empty.asset --headless --size 8x8 --play flight.osrectxt --fps 10 --output frames");
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_TRUE(fs::exists(in("frames/frame_000005.png")));
  EXPECT_FALSE(fs::exists(in("frames/frame_000006.png")));
}

TEST_F(CommandLine, ADamagedLineOfARecordingIsNamed) {
  emptyScene();
  write("flight.osrectxt",
        "OpenSpace_record/playback03.00A\n"
        "camera 0.0 0.0 0.0 0.0 5000.0 0.0 0.0 0.0 1.0 1.0 - Place\n"
        "camera 0.5 half 0.0 0.0 3000.0 0.0 0.0 0.0 1.0 1.0 - Place\n");
  const Outcome outcome = run("empty.asset --headless --size 8x8 --play flight.osrectxt");
  EXPECT_EQ(outcome.code, 1);
  for (const char* part : {"flight.osrectxt:3", "'half'", "correct the line"}) {
    EXPECT_THAT(outcome.errors, HasSubstr(part));
  }
}

TEST_F(CommandLine, ARecordingThatStopsItselfEndsTheRun) {
  emptyScene();
  write("flight.osrectxt",
        "OpenSpace_record/playback03.00A\n"
        "camera 0.0 0.0 0.0 0.0 5000.0 0.0 0.0 0.0 1.0 1.0 - Place\n"
        "script 0.25 0.25 1 openspace.sessionRecording.stopPlayback()\n"
        "camera 9.0 9.0 0.0 0.0 3000.0 0.0 0.0 0.0 1.0 1.0 - Place\n");
  // Without --frames it would fill the disk if it went on.
  const Outcome outcome =
      run("empty.asset --headless --size 8x8 --play flight.osrectxt --fps 10 --frames 30 --output frames");
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_TRUE(fs::exists(in("frames/frame_000003.png")));
  EXPECT_FALSE(fs::exists(in("frames/frame_000004.png")));
}

/// A recording of half a second that pauses itself after a quarter of one, and what else it does then.
std::string pausingFlight(const std::string& more) {
  return "OpenSpace_record/playback03.00A\n"
         "camera 0.0 0.0 0.0 0.0 5000.0 0.0 0.0 0.0 1.0 1.0 - Place\n"
         "script 0.25 0.25 1 openspace.sessionRecording.setPlaybackPause(true) " +
         more + "\ncamera 0.5 0.5 0.0 0.0 3000.0 0.0 0.0 0.0 1.0 1.0 - Place\n";
}

TEST_F(CommandLine, ARecordingThatPausesForGoodFails) {
  emptyScene();
  write("flight.osrectxt", pausingFlight(""));
  const std::string arguments = "empty.asset --headless --size 64x64 --play flight.osrectxt --fps 10 --output ";
  const Outcome outcome = run(arguments + "frames.mkv");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.errors, HasSubstr("flight.osrectxt:3: the playback was paused"));
  EXPECT_GT(fs::file_size(in("frames.mkv")), 100U) << "what was drawn is kept";
  const Outcome counted = run(arguments + "frames --frames 6");
  EXPECT_EQ(counted.code, 0) << counted.errors;
  EXPECT_TRUE(fs::exists(in("frames/frame_000005.png")));
}

TEST_F(CommandLine, APauseOfARecordingThatSomethingEndsDoesNotEndTheRun) {
  emptyScene();
  const std::string goOn = "openspace.sessionRecording.setPlaybackPause(false)";
  const std::pair<std::string, int> cases[] = {
      // By the next frame's script, by that of a movement of three frames, by a later entry of the same frame.
      {"openspace.action.registerAction({ Identifier = 'on', Command = '" + goOn +
           "' }) openspace.action.triggerAction('on')",
       5},
      {"openspace.setPropertyValueSingle('Navigation.Sensitivity', 2.0, 0.3, 'Linear', '" + goOn + "')", 8},
      {"\nscript 0.26 0.26 1 " + goOn, 5}};
  for (const auto& [more, last] : cases) {
    write("flight.osrectxt", pausingFlight(more));
    fs::remove_all(in("frames"));
    const Outcome outcome = run("empty.asset --headless --size 8x8 --play flight.osrectxt --fps 10 --output frames");
    EXPECT_EQ(outcome.code, 0) << outcome.errors;
    EXPECT_TRUE(fs::exists(in("frames/frame_00000" + std::to_string(last) + ".png"))) << more;
    EXPECT_FALSE(fs::exists(in("frames/frame_00000" + std::to_string(last + 1) + ".png"))) << more;
  }
}

TEST_F(CommandLine, AFullDiskEndsTheRunOnlyWithRecord) {
  emptyScene();
  write("record.lua", "openspace.sessionRecording.startRecording()");
  // No file gets longer than a few KiB, as on a disk that is full.
  write("full.sh", "trap '' XFSZ\nulimit -f 8\n\"$@\"\n");
  const std::string frames = "empty.asset --headless --size 8x8 --fps 10 --frames 200 ";
  const Outcome scripted = run(frames + "--script record.lua", "sh full.sh");
  EXPECT_EQ(scripted.code, 0) << scripted.errors;
  EXPECT_THAT(scripted.errors, HasSubstr("the recording ends here"));
  EXPECT_THAT(scripted.errors, HasSubstr("make room on the disk"));
  const Outcome asked = run(frames + "--record session.osrectxt", "sh full.sh");
  EXPECT_EQ(asked.code, 1);
  EXPECT_THAT(asked.errors, HasSubstr("make room on the disk"));
}

TEST_F(CommandLine, AnInterruptedRunClosesItsOutput) {
  emptyScene();
  // Interrupts what it is told to run once that has written some pictures, however long it takes to start.
  write("interrupting.sh", R"(
    "$@" &
    while [ ! -e pictures/frame_000003.png ] && kill -0 $!; do sleep 0.05; done
    kill -TERM $!
    wait $!
  )");
  const Outcome outcome =
      run("empty.asset --headless --size 64x64 --frames 1000000 --output pictures --stats stats.json",
          "sh interrupting.sh");
  EXPECT_EQ(outcome.code, 1) << outcome.errors;
  EXPECT_THAT(outcome.errors, HasSubstr("interrupted"));
  EXPECT_GT(nlohmann::json::parse(readFile(in("stats.json")))["frames"], 1);
}

TEST_F(CommandLine, AFolderIsNoAsset) {
  fs::create_directories(in("scene"));
  const Outcome outcome = run("scene --headless --size 8x8");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.errors, HasSubstr("this is a folder"));
}

TEST_F(CommandLine, SaysWhichRasterCannotBeUsed) {
  write("text.tif", "this is no raster");
  fs::create_directories(in("folder.tif"));
  for (const char* file : {"missing.tif", "folder.tif", "text.tif"}) {
    write("globe.asset", std::string(R"(
      local globe = { Identifier = "Globe", Renderable = { Type = "RenderableGlobe", Radii = { 6e6, 6e6, 6e6 },
        Layers = { ColorLayers = { { Identifier = "Broken", FilePath = ")") +
                             file + R"(", Enabled = true } } } } }
      asset.onInitialize(function() openspace.addSceneGraphNode(globe) end)
    )");
    if (run("--validate globe.asset").out.find("globes 1") == std::string::npos) {
      GTEST_SKIP() << "built without the module that brings globes";
    }
    const Outcome outcome = run("globe.asset --headless --size 64x64 --settle 30 --output picture.png");
    EXPECT_EQ(outcome.code, 0) << outcome.errors;
    EXPECT_TRUE(fs::exists(in("picture.png"))) << "everything else keeps working";
    const std::size_t first = outcome.errors.find(file);
    ASSERT_NE(first, std::string::npos) << outcome.errors;
    EXPECT_THAT(outcome.errors, HasSubstr("error"));
  }
  EXPECT_THAT(run("--validate globe.asset").errors, Not(HasSubstr("not usable"))) << "it is not read";
  fs::remove(in("text.tif"));
  const Outcome checked = run("--validate globe.asset");
  EXPECT_THAT(checked.out, HasSubstr("layers 1 usable 0"));
  EXPECT_THAT(checked.errors, HasSubstr("text.tif"));
}

TEST_F(CommandLine, PicturesSayWhomTheirDataAreToBeCreditedTo) {
  write("globe.asset", R"(
    local globe = { Identifier = "Globe", Renderable = { Type = "RenderableGlobe", Radii = 6e6, PerformShading = false,
      Layers = { ColorLayers = {
        { Identifier = "Seen", Type = "SolidColor", Color = { 0.5, 0.5, 0.5 }, Enabled = true,
          Attribution = "\u{a9} The\n  makers" },
        { Identifier = "Off", Type = "SolidColor", Color = { 1, 0, 0 }, Attribution = "Others" } } } } }
    asset.onInitialize(function() openspace.addSceneGraphNode(globe) end)
  )");
  if (run("--validate globe.asset").out.find("globes 1") == std::string::npos) {
    GTEST_SKIP() << "built without the module that brings globes";
  }
  const std::string arguments = "globe.asset --headless --size 320x200 --camera 0,0,3e6 --settle 30 --output ";
  const Outcome shown = run(arguments + "shown.png");
  ASSERT_EQ(shown.code, 0) << shown.errors;
  ASSERT_EQ(run(arguments + "bare.png --set RenderEngine.ShowAttribution=false").code, 0);
  const auto with = meridian::graphics::readPng(in("shown.png")).value();
  const auto without = meridian::graphics::readPng(in("bare.png")).value();
  EXPECT_EQ(with.metadata.at("Copyright"), "\u00a9 The makers");
  EXPECT_EQ(without.metadata, with.metadata) << "words are no part of the picture";
  std::size_t first = with.pixels.size();
  for (std::size_t i = 0; i < with.pixels.size(); ++i) {
    if (with.pixels[i] != without.pixels[i]) {
      first = std::min(first, i / 4 / 320);
    }
  }
  EXPECT_GT(first, 180U) << "the first row that differs";
  EXPECT_LT(first, 200U);
}

TEST_F(CommandLine, AnUnwritableCacheOnlyWarns) {
  emptyScene();
  const Outcome outcome = run("empty.asset --headless --size 8x8 --output picture.png", "XDG_CACHE_HOME=/dev/null");
  EXPECT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_THAT(outcome.errors, HasSubstr("XDG_CACHE_HOME"));
}

}  // namespace
}  // namespace meridian::app
