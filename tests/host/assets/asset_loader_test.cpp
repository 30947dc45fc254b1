#include "host/assets/asset_loader.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "host/assets/file_scripts.h"
#include "host/assets/validate.h"
#include "host/scripting/actions.h"
#include "temporary_folder.h"

namespace meridian::assets {
namespace {

struct RecordedTarget : AssetTarget {
  Result<void> addNode(const Value& table, const std::string& where, const std::string& folder) override {
    const Value* identifier = table.find("Identifier");
    if (identifier == nullptr) {
      return failure("the node has no Identifier", where + ": Identifier");
    }
    if (hasNode(*identifier->string())) {
      return failure("there is a node already", where + ": Identifier");
    }
    nodes.push_back(*identifier->string());
    places.push_back(where);
    folders.push_back(folder);
    return {};
  }
  Result<void> removeNode(const std::string& identifier) override {
    if (std::erase(nodes, identifier) == 0) {
      return failure("no such node", identifier);
    }
    return {};
  }
  [[nodiscard]] bool hasNode(const std::string& identifier) const override {
    return std::find(nodes.begin(), nodes.end(), identifier) != nodes.end();
  }
  std::vector<std::string> nodes, places, folders;
};

class AssetLoaderTest : public testing::Test {
 protected:
  AssetLoaderTest() {
    tokens_.set("ASSETS", folder_.path());
    tokens_.set("SYNC", folder_.path() / "sync");
    engine_.registerLibrary({"", {{"note", "text", "", 1, 1, [this](std::span<const Value> a) -> ScriptResult {
                                     notes_ += a[0].string() != nullptr ? *a[0].string() : a[0].toLua();
                                     notes_ += ' ';
                                     return {};
                                   }}}});
    const NoteRegistration note = [this](std::string name, std::function<void()> takeBack) {
      loader_.noteRegistration(std::move(name), std::move(takeBack));
    };
    engine_.registerLibrary(scripting::actionLibrary(actions_, note));
    engine_.registerLibrary(scripting::keyLibrary(keys_, note));
  }
  Error errorOf(std::string_view path) {
    const Result<void> result = loader_.add(path);
    return result ? Error{"no error", ""} : result.error();
  }
  std::string at(std::string_view name, int line) {
    return (folder_.path() / name).string() + ':' + std::to_string(line);
  }
  const AssetReport& report(std::string_view name) {
    reports_ = loader_.reports();
    const auto found = std::find_if(reports_.begin(), reports_.end(),
                                    [&](const AssetReport& each) { return each.file == folder_.path() / name; });
    EXPECT_NE(found, reports_.end()) << name;
    return *found;
  }

  TemporaryFolder folder_;
  scripting::ScriptEngine engine_{{std::size_t{64} << 20, 5'000'000}};
  PathTokens tokens_;
  RecordedTarget target_;
  scripting::Actions actions_{engine_};
  scripting::KeyBindings keys_{actions_};
  AssetLoader loader_{engine_, tokens_, target_};
  std::string notes_;
  std::vector<AssetReport> reports_;
};

TEST_F(AssetLoaderTest, LoadsADiamondOnceAndInitialisesChildrenFirst) {
  const std::string hooks =
      "asset.onInitialize(function() openspace.note('NAME') end)\n"
      "asset.onDeinitialize(function() openspace.note('-NAME') end)\n";
  const auto body = [&](std::string name, const std::string& before) {
    std::string text = before + "openspace.note('run' .. 'NAME')\n" + hooks;
    for (std::size_t i; (i = text.find("NAME")) != std::string::npos;) {
      text.replace(i, 4, name);
    }
    return text;
  };
  folder_.write("top.asset", body("Top", "asset.require('./left') asset.require('right')\n"));
  folder_.write("left.asset", body("Left", "asset.require('./deep/base')\n"));
  folder_.write("right.asset", body("Right", "asset.require('${ASSETS}/deep/base.asset')\n"));
  folder_.write("deep/base.asset", body("Base", ""));
  ASSERT_TRUE(loader_.add("top"));
  EXPECT_EQ(notes_, "runBase runLeft runRight runTop Base Left Right Top ");
  EXPECT_TRUE(loader_.isLoaded("deep/base"));
  EXPECT_EQ(loader_.reports().size(), 4u);
  notes_.clear();
  ASSERT_TRUE(loader_.remove("top"));
  EXPECT_EQ(notes_, "-Top -Right -Left -Base ");
  EXPECT_TRUE(loader_.reports().empty());
  ASSERT_TRUE(loader_.add("top"));
}

TEST_F(AssetLoaderTest, LoadsAssetsInJson) {
  folder_.write("top.asset", "asset.require('./thing') openspace.note('top')");
  folder_.write("base.asset", "asset.onInitialize(function() openspace.note('base') end)");
  folder_.write("thing.jasset", R"({ "dependencies": ["base"], "scenegraphnodes": [{ "Identifier": "Thing" }] })");
  ASSERT_TRUE(loader_.add("top"));
  EXPECT_EQ(target_.nodes, std::vector<std::string>{"Thing"});
  EXPECT_EQ(notes_, "top base ");
  loader_.removeAll();
  EXPECT_TRUE(target_.nodes.empty());
  folder_.write("broken.jasset", "{");
  EXPECT_NE(errorOf("broken").message().find("broken.jasset:1"), std::string::npos);
}

TEST_F(AssetLoaderTest, TellsTheFirstCauseAndNoChain) {
  folder_.write("a.asset", "asset.require('./b')");
  folder_.write("b.asset", "asset.require('./c')");
  folder_.write("c.asset", "error('broken')");
  const std::string message = errorOf("a").message();
  EXPECT_NE(message.find("c.asset:1: broken"), std::string::npos) << message;
  EXPECT_EQ(message.find("b.asset"), std::string::npos) << message;
  // A failure that the asset met itself is no excuse for another one.
  folder_.write("d.asset", "pcall(function() asset.require('./c') end) error('own')");
  folder_.write("e.asset", "asset.require('./d')");
  EXPECT_NE(errorOf("e").message().find("own"), std::string::npos);
}

TEST_F(AssetLoaderTest, DataThatWereNotSynchronisedAreNoError) {
  engine_.registerLibrary(fileLibrary(
      tokens_, [this] { return loader_.currentFolder(); },
      [this](const std::filesystem::path& path) { loader_.noteMissing(path); }));
  folder_.write("stars.asset", R"(
    local folder = asset.resource({ Type = "HttpSynchronization", Identifier = "stars", Version = 1 })
    asset.export("answer", 42)
    asset.onInitialize(function()
      assert(#openspace.walkDirectoryFiles(folder .. "more") == 0)
      openspace.note(openspace.readFileLines(folder .. "stars.csv")[1]:upper())
    end)
  )");
  folder_.write("sky.asset",
                "local stars = asset.require('./stars')\n"
                "asset.onInitialize(function() openspace.note(stars.answer) end)");
  EXPECT_TRUE(loader_.add("sky"));
  EXPECT_EQ(notes_, "42 ");
  EXPECT_FALSE(report("stars.asset").ok);
  EXPECT_FALSE(report("stars.asset").available);
  EXPECT_TRUE(report("sky.asset").ok);
  EXPECT_TRUE(loader_.add("stars")) << "by itself, too";
  // A mistake of its own is one, whatever else is not there.
  folder_.write("broken.asset", "error('broken')");
  EXPECT_FALSE(loader_.add("broken"));
  EXPECT_TRUE(report("broken.asset").available);
  folder_.write("sync/http/stars/1/stars.csv", "sun");
  loader_.removeAll();
  notes_.clear();
  ASSERT_TRUE(loader_.add("sky"));
  EXPECT_EQ(notes_, "SUN 42 ");
}

TEST_F(AssetLoaderTest, AssetsThatAreAddedByAssetsComeWithTheNextFrame) {
  folder_.write("more.asset", "openspace.note('more')");
  folder_.write("top.asset", "asset.onInitialize(function() openspace.asset.add('more') end)");
  ASSERT_TRUE(loader_.add("top"));
  EXPECT_EQ(notes_, "");
  EXPECT_TRUE(engine_.runQueued().empty());
  EXPECT_EQ(notes_, "more ");
}

TEST_F(AssetLoaderTest, AnInitialisationThatWaitsGoesOnAsItsAsset) {
  bool isThere = false;
  engine_.registerLibrary(
      {"late",
       {{"value", "", "", 0, 0, [](std::span<const Value>) -> ScriptResult { return std::vector<Value>{"value"}; },
         [&](std::span<const Value>) { return !isThere; }}}});
  const auto text = [](const std::string& name) {
    return "asset.onInitialize(function() openspace.note(openspace.late.value())"
           " openspace.addSceneGraphNode({ Identifier = '" +
           name + "' }) openspace.note(asset.resource('a.txt')) end)";
  };
  folder_.write("deep/a.txt", "");
  folder_.write("deep/one.asset", text("One"));
  folder_.write("deep/two.asset", text("Two"));
  ASSERT_TRUE(loader_.add("deep/one"));
  ASSERT_TRUE(loader_.add("deep/two"));
  EXPECT_EQ(notes_, "");
  ASSERT_TRUE(loader_.remove("deep/two"));
  isThere = true;
  EXPECT_TRUE(engine_.resumeWaiting().empty());
  EXPECT_EQ(notes_, "value " + (folder_.path() / "deep/a.txt").string() + " ");
  EXPECT_EQ(target_.nodes, std::vector<std::string>{"One"});
  EXPECT_EQ(target_.folders.back(), (folder_.path() / "deep").string());
}

TEST_F(AssetLoaderTest, KeepsWhatAnotherRootNeeds) {
  folder_.write("base.asset", "asset.onDeinitialize(function() openspace.note('gone') end)");
  folder_.write("a.asset", "asset.require('./base')");
  folder_.write("b.asset", "asset.require('./base')");
  ASSERT_TRUE(loader_.add("a"));
  ASSERT_TRUE(loader_.add("b"));
  ASSERT_TRUE(loader_.remove("a"));
  EXPECT_EQ(notes_, "");
  ASSERT_TRUE(loader_.remove("b"));
  EXPECT_EQ(notes_, "gone ");
}

TEST_F(AssetLoaderTest, RunsSeveralOnDeinitializeInReverse) {
  folder_.write("a.asset",
                "asset.onDeinitialize(function() openspace.note('first') end)\n"
                "asset.onDeinitialize(function() openspace.note('second') end)");
  ASSERT_TRUE(loader_.add("a"));
  loader_.removeAll();
  EXPECT_EQ(notes_, "second first ");
}

TEST_F(AssetLoaderTest, ExportsValuesTablesAndFunctions) {
  folder_.write("lib.asset",
                "local Earth = { Identifier = 'Earth', Radius = 6 }\nasset.export(Earth)\n"
                "asset.export('twice', function(x) return 2 * x end)\n"
                "asset.export('folder', function() return asset.directory end)");
  folder_.write("sub/user.asset",
                "local lib = asset.require('lib')\n"
                "openspace.note(lib.Earth.Radius .. '/' .. lib.twice(4))\n"
                "assert(lib.folder() ~= asset.directory and asset.require('lib') == lib)");
  const Result<void> result = loader_.add("sub/user");
  ASSERT_TRUE(result) << result.error().message();
  EXPECT_EQ(notes_, "6/8 ");
  folder_.write("bad.asset", "\nasset.export({ Name = 'no identifier' })");
  EXPECT_EQ(errorOf("bad").where, at("bad.asset", 2));
}

TEST_F(AssetLoaderTest, GivesEachAssetItsOwnAssetTableAndSharesTheOtherGlobals) {
  folder_.write("a.asset",
                "asset.require('./b')\nshared = shared + 1\nasset.onInitialize(function()\n"
                "openspace.note(asset.filePath:match('[^/]*$') .. shared) end)");
  folder_.write("b.asset", "shared = 1");
  ASSERT_TRUE(loader_.add("a"));
  EXPECT_EQ(notes_, "a.asset2 ");
}

TEST_F(AssetLoaderTest, AnErrorFailsTheAssetAndItsParentsAndNobodyElse) {
  folder_.write("bad.asset", "\n\nlocal x = nil + 1");
  folder_.write("parent.asset", "\nasset.require('./bad')");
  folder_.write("good.asset", "openspace.addSceneGraphNode({ Identifier = 'Good' })");
  const auto files = findAssets(folder_.path());
  ASSERT_TRUE(files);
  const std::vector<AssetReport> reports = validate(loader_, *files);
  EXPECT_EQ(reports.size(), 3u);
  EXPECT_EQ(std::count_if(reports.begin(), reports.end(), [](const AssetReport& each) { return each.ok; }), 1);
  EXPECT_EQ(report("bad.asset").errors.at(0).where, at("bad.asset", 3));
  EXPECT_EQ(report("parent.asset").errors.at(0).where, at("parent.asset", 2));
  EXPECT_NE(report("parent.asset").errors.at(0).what.find(at("bad.asset", 3)), std::string::npos);
  EXPECT_EQ(target_.nodes, std::vector<std::string>{"Good"});
}

TEST_F(AssetLoaderTest, AFailingInitialisationFailsTheParents) {
  folder_.write("bad.asset", "asset.onInitialize(function()\nerror('cannot')\nend)");
  folder_.write("parent.asset", "asset.require('./bad')\nasset.onInitialize(function() openspace.note('never') end)");
  EXPECT_FALSE(loader_.add("parent"));
  EXPECT_EQ(report("bad.asset").errors.at(0).where, at("bad.asset", 2));
  EXPECT_EQ(report("bad.asset").errors.at(0).what, "cannot");
  EXPECT_FALSE(report("parent.asset").ok);
  EXPECT_EQ(notes_, "");
}

TEST_F(AssetLoaderTest, ReportsACircle) {
  folder_.write("a.asset", "asset.require('./b')");
  folder_.write("b.asset", "asset.require('./c')");
  folder_.write("c.asset", "\nasset.require('./a')");
  EXPECT_FALSE(loader_.add("a"));
  const Error error = report("c.asset").errors.at(0);
  EXPECT_EQ(error.where, at("c.asset", 2));
  EXPECT_NE(error.what.find("a.asset -> b.asset -> c.asset -> a.asset"), std::string::npos) << error.what;
  folder_.write("self.asset", "asset.require('./self')");
  EXPECT_NE(errorOf("self").what.find("circle"), std::string::npos);
}

TEST_F(AssetLoaderTest, NamesFileAndLineOfEveryError) {
  const std::pair<const char*, const char*> cases[] = {
      {"syntax", "local x = 1\nlocal y = = 2"},
      {"missing", "local x = 1\nasset.require('./nothing')"},
      {"member", "local x = 1\nasset.fly()"},
      {"spice", "local x = 1\nopenspace.spice.loadKernel('x')"},
      {"endless", "local x = 1\nwhile true do end"},
      {"node", "local x = 1\nopenspace.addSceneGraphNode({})"},
      {"token", "local x = 1\nasset.resource('${NOWHERE}/x')"},
      {"sync", "local x = 1\nasset.resource({ Type = 'HttpSynchronization', Identifier = '../x', Version = 1 })"},
      {"function", "local x = 1\nasset.onInitialize(3)"}};
  for (const auto& [name, text] : cases) {
    const std::string file = std::string(name) + ".asset";
    folder_.write(file, text);
    EXPECT_EQ(errorOf(name).where.rfind(at(file, 2), 0), 0u) << errorOf(name).message();
  }
  EXPECT_EQ(errorOf("nothing").what, "no such asset");
  std::filesystem::create_directory(folder_.path() / "folder.asset");
  EXPECT_EQ(errorOf("folder").what, "this is a folder, not an asset");
}

TEST_F(AssetLoaderTest, ResolvesResources) {
  folder_.write("x/a.asset",
                "openspace.note(asset.resource('map.tif')) openspace.note(asset.resource())\n"
                "openspace.note(asset.localResource('../y/map.tif'))\n"
                "openspace.note(asset.resource({ Type = 'HttpSynchronization', Identifier = 'maps', "
                "Version = 2 }))\n"
                "openspace.note(asset.syncedResource({ Type = 'UrlSynchronization', Identifier = 'one', "
                "Url = 'http://x/y' }))");
  ASSERT_TRUE(loader_.add("x/a"));
  const std::string root = folder_.path().string();
  EXPECT_EQ(notes_, root + "/x/map.tif " + root + "/x " + root + "/y/map.tif " + root + "/sync/http/maps/2/ " + root +
                        "/sync/url/one/ ");
}

TEST_F(AssetLoaderTest, TellsTheSceneWhereANodeComesFrom) {
  folder_.write("x/a.asset",
                "asset.meta = { Name = 'The A' }\nassert(asset.exists('./a') and not asset.exists('b'))\n"
                "asset.onInitialize(function()\nopenspace.addSceneGraphNode({ Identifier = 'A' })\nend)\n"
                "asset.onDeinitialize(function() openspace.removeSceneGraphNode({Identifier = 'A'}) end)");
  ASSERT_TRUE(loader_.add((folder_.path() / "x/a.asset").string()));
  EXPECT_EQ(target_.places, std::vector<std::string>{at("x/a.asset", 4)});
  EXPECT_EQ(target_.folders, std::vector<std::string>{(folder_.path() / "x").string()});
  EXPECT_EQ(report("x/a.asset").name, "The A");
  loader_.removeAll();
  EXPECT_TRUE(target_.nodes.empty());
}

TEST_F(AssetLoaderTest, PassesEnabledOn) {
  folder_.write("a.asset", "asset.require('./b', false) asset.require('./c')");
  folder_.write("b.asset", "openspace.note(tostring(asset.enabled))");
  folder_.write("c.asset", "openspace.note(tostring(asset.enabled))");
  ASSERT_TRUE(loader_.add("a"));
  EXPECT_EQ(notes_, "false true ");
}

TEST_F(AssetLoaderTest, ScriptsAddAndRemoveAssets) {
  folder_.write("a.asset", "openspace.note('a')");
  ASSERT_TRUE(
      engine_.run("openspace.asset.add('a') assert(openspace.asset.isLoaded('a')) openspace.asset.remove('a') "
                  "assert(#openspace.asset.allAssets() == 0)",
                  "test"));
}

TEST_F(AssetLoaderTest, ScriptsReloadAssetsAndAskWhoRequiresThem) {
  folder_.write("base.asset", "openspace.note('base')");
  folder_.write("a.asset", "asset.require('./base') openspace.note('a')");
  ASSERT_TRUE(engine_.run("openspace.asset.add('a')", "test"));
  EXPECT_EQ(notes_, "base a ");
  folder_.write("a.asset", "asset.require('./base') openspace.note('b')");
  ASSERT_TRUE(engine_.run("openspace.asset.reload('a')", "test"));
  EXPECT_EQ(notes_, "base a base b ");
  ASSERT_TRUE(
      engine_.run("local p = openspace.asset.parents('base') assert(#p == 1 and p[1]:find('a.asset')) "
                  "assert(#openspace.asset.parents('a') == 0)",
                  "test"));
  EXPECT_FALSE(engine_.run("openspace.asset.reload('base')", "test")) << "nobody added it";
  ASSERT_TRUE(engine_.run("openspace.asset.removeAll() assert(#openspace.asset.allAssets() == 0)", "test"));
}

TEST_F(AssetLoaderTest, FunctionsThatOutliveTheirAssetSaySo) {
  folder_.write("a.asset",
                "local resource, deinitialize, require = asset.resource, asset.onDeinitialize, asset.require\n"
                "function helper() return resource('x') end\n"
                "function late() deinitialize(function() openspace.note('ghost') end) end\n"
                "function more() return require('./b') end");
  folder_.write("b.asset", "openspace.note('b')");
  ASSERT_TRUE(loader_.add("a"));
  ASSERT_TRUE(engine_.run("openspace.note(helper())", "test"));
  EXPECT_EQ(notes_, (folder_.path() / "x").string() + ' ');
  notes_.clear();
  ASSERT_TRUE(engine_.run("old = { helper, late, more }", "test"));
  const auto refuseAll = [&] {
    for (const char* call : {"old[1]()", "old[2]()", "old[3]()"}) {
      const Result<void> done = engine_.run(call, "test");
      ASSERT_FALSE(done) << call;
      EXPECT_NE(done.error().message().find((folder_.path() / "a.asset").string() + ":"), std::string::npos);
      EXPECT_NE(done.error().what.find("was removed"), std::string::npos) << done.error().message();
    }
  };
  ASSERT_TRUE(engine_.run("openspace.asset.reload('a')", "test"));
  refuseAll();
  EXPECT_TRUE(engine_.run("helper()", "test")) << "that of the asset which is there now";
  ASSERT_TRUE(loader_.remove("a"));
  refuseAll();
  EXPECT_EQ(notes_, "");
}

TEST_F(AssetLoaderTest, AnAssetThatGoesMayStillSayWhatToDoWhenItGoes) {
  folder_.write("a.asset",
                "asset.onDeinitialize(function()\n"
                "for i = 1, 50 do asset.onDeinitialize(function() openspace.note('too late') end) end\n"
                "openspace.note('gone') end)\n"
                "asset.onDeinitialize(function() asset.onDeinitialize(function() end) end)");
  ASSERT_TRUE(loader_.add("a"));
  ASSERT_TRUE(loader_.remove("a"));
  EXPECT_EQ(notes_, "gone ");
}

TEST_F(AssetLoaderTest, WhatAFailedAssetAddedGoesWithIt) {
  using Nodes = std::vector<std::string>;
  const auto asset = [&](const std::string& second) {
    folder_.write("a.asset",
                  "asset.onInitialize(function() openspace.addSceneGraphNode({ Identifier = 'First' })\n"
                  "openspace.addSceneGraphNode({ " +
                      second +
                      " = 'Second' }) end)\n"
                      "asset.onDeinitialize(function() openspace.removeSceneGraphNode('Second')\n"
                      "openspace.removeSceneGraphNode('First') end)");
  };
  asset("Identifer");
  folder_.write("top.asset", "asset.require('./a') openspace.addSceneGraphNode({ Identifier = 'Top' })");
  EXPECT_FALSE(loader_.add("top"));
  EXPECT_EQ(target_.nodes, (Nodes{"Top", "First"}));
  asset("Identifier");
  const Result<void> again = engine_.run("openspace.asset.reload('top')", "test");
  ASSERT_TRUE(again) << again.error().message();
  EXPECT_EQ(target_.nodes, (Nodes{"Top", "First", "Second"}));
}

TEST_F(AssetLoaderTest, AFailedAssetTakesNoNodeOfAnotherWithIt) {
  const std::string node =
      "asset.onInitialize(function() openspace.addSceneGraphNode({ Identifier = 'Earth' }) end)\n"
      "asset.onDeinitialize(function() openspace.removeSceneGraphNode('Earth') end)";
  folder_.write("a.asset", node);
  folder_.write("b.asset", node);
  folder_.write("c.asset", "openspace.addSceneGraphNode({ Identifier = 'Mars' }) error('broken')");
  ASSERT_TRUE(loader_.add("a"));
  EXPECT_FALSE(loader_.add("b"));
  EXPECT_FALSE(loader_.add("c"));
  ASSERT_TRUE(engine_.run("openspace.removeSceneGraphNode('Mars')", "test"));
  folder_.write("d.asset", "openspace.addSceneGraphNode({ Identifier = 'Mars' })");
  ASSERT_TRUE(loader_.add("d"));
  ASSERT_TRUE(loader_.remove("b"));
  ASSERT_TRUE(loader_.remove("c"));
  EXPECT_EQ(target_.nodes, (std::vector<std::string>{"Earth", "Mars"}));
}

TEST_F(AssetLoaderTest, AnAssetThatFailedAfterRegisteringActionsAndKeysCanBeReloaded) {
  const auto asset = [&](const std::string& key, const std::string& end) {
    folder_.write(
        "a.asset",
        "openspace.action.registerAction({ Identifier = 'sun', Command = '' })\n"
        "asset.onInitialize(function() openspace.action.registerAction({ Identifier = 'moon', Command = '' })\n"
        "openspace.bindKey('" +
            key + "', 'sun') " + end + " end)");
  };
  asset("Ctrl+S", "error('broken')");
  EXPECT_FALSE(loader_.add("a"));
  asset("Ctrl+T", "");
  const Result<void> again = engine_.run("openspace.asset.reload('a')", "test");
  ASSERT_TRUE(again) << again.error().message();
  EXPECT_NE(actions_.find("sun"), nullptr);
  EXPECT_NE(actions_.find("moon"), nullptr);
  EXPECT_EQ(keys_.keysOf("sun"), std::vector<std::string>{"CTRL+T"});
}

TEST_F(AssetLoaderTest, AFailedAssetTakesNothingWithItThatIsAnothersByNow) {
  folder_.write("a.asset",
                "openspace.action.registerAction({ Identifier = 'sun', Command = '' })\n"
                "openspace.addSceneGraphNode({ Identifier = 'Mars' }) error('broken')");
  EXPECT_FALSE(loader_.add("a"));
  // No asset registers these, so that none takes them over.
  ASSERT_TRUE(
      engine_.run("openspace.action.removeAction('sun')\n"
                  "openspace.action.registerAction({ Identifier = 'sun', Command = 'mine' })\n"
                  "openspace.removeSceneGraphNode('Mars') openspace.addSceneGraphNode({ Identifier = 'Mars' })",
                  "test"));
  ASSERT_TRUE(loader_.remove("a"));
  ASSERT_NE(actions_.find("sun"), nullptr);
  EXPECT_EQ(actions_.find("sun")->command, "mine");
  EXPECT_EQ(target_.nodes, std::vector<std::string>{"Mars"});
}

TEST_F(AssetLoaderTest, FindsTheAssetsFolder) {
  const auto file = folder_.write("assets/earth/globe.asset", "");
  EXPECT_EQ(assetsFolder(file, "/else"), folder_.path() / "assets");
  EXPECT_EQ(assetsFolder(folder_.path() / "assets/earth", "/else"), folder_.path() / "assets/earth");
  EXPECT_EQ(assetsFolder(folder_.path() / "x.asset", "/else"), "/else");
  EXPECT_FALSE(findAssets(folder_.path() / "nothing"));
}

}  // namespace
}  // namespace meridian::assets
