#include "host/assets/file_scripts.h"

#include <gtest/gtest.h>

#include "host/scripting/script_engine.h"
#include "temporary_folder.h"

namespace meridian::assets {
namespace {

class FileScriptsTest : public testing::Test {
 protected:
  FileScriptsTest() {
    open_.write("a.txt", "alpha");
    open_.write("sub/b.txt", "beta");
    secret_.write("key", "secret");
    std::filesystem::create_symlink(secret_.path(), open_.path() / "link");
    std::filesystem::create_symlink(secret_.path() / "key", open_.path() / "keylink");
    std::filesystem::create_symlink(open_.path(), open_.path() / "sub/circle");
    std::filesystem::create_directory(open_.path() / "cache");
    std::filesystem::create_symlink(secret_.path(), open_.path() / "cache/out");
    tokens_.set("ASSETS", open_.path());
    tokens_.set("CACHE", open_.path() / "cache");
    engine_.registerLibrary(fileLibrary(tokens_, [this] { return open_.path().string(); }));
    (void)engine_.run("outside = '" + secret_.path().string() + "'", "test");
  }
  Value value(const std::string& expression) {
    const auto values = engine_.evaluate(expression, "test");
    EXPECT_TRUE(values) << expression << ": " << values.error().message();
    return values && !values->empty() ? values->front() : Value("failed");
  }

  TemporaryFolder open_;
  TemporaryFolder secret_;
  PathTokens tokens_;
  scripting::ScriptEngine engine_;
};

TEST_F(FileScriptsTest, ReadsAndFindsBelowAllowedFolders) {
  EXPECT_EQ(value("openspace.readFile('a.txt')"), Value("alpha"));
  EXPECT_EQ(value("openspace.readFile('${ASSETS}/sub/../sub/b.txt')"), Value("beta"));
  EXPECT_EQ(value("openspace.fileExists('a.txt')"), Value(true));
  EXPECT_EQ(value("openspace.fileExists('sub')"), Value(false));
  EXPECT_EQ(value("openspace.directoryExists('${ASSETS}/sub')"), Value(true));
  EXPECT_EQ(value("openspace.absPath('${ASSETS}/x/../y')"), Value((open_.path() / "y").string()));
  EXPECT_EQ(value("openspace.directoryForPath('sub/b.txt')"), Value((open_.path() / "sub").string()));
}

TEST_F(FileScriptsTest, ReachesNothingElse) {
  for (const char* text :
       {"openspace.readFile(outside .. '/key')", "openspace.readFile('/etc/passwd')",
        "openspace.readFile('../../../../../../etc/passwd')", "openspace.readFile('${ASSETS}/../../etc/passwd')",
        "openspace.readFile('link/key')", "openspace.readFile('keylink')", "openspace.readFile('sub')",
        "openspace.walkDirectory(outside)", "openspace.walkDirectory('link')", "openspace.readFile('a.txt\\0.png')",
        "openspace.setPathToken('${MINE}', '/')", "openspace.setPathToken('${CACHE}', '${ASSETS}')",
        "openspace.writeFile('a.txt', '')", "openspace.writeFile('${ASSETS}/new', '')",
        "openspace.writeFile('${CACHE}/../a.txt', '')", "openspace.writeFile('${CACHE}/out/key', '')",
        "openspace.writeFile(outside .. '/key', '')"}) {
    const Result<void> result = engine_.run(text, "test");
    EXPECT_FALSE(result) << text;
  }
  EXPECT_EQ(value("openspace.fileExists(outside .. '/key')"), Value(false));
  EXPECT_EQ(value("openspace.directoryExists('/etc')"), Value(false));
  std::ifstream kept(secret_.path() / "key");
  std::string text;
  kept >> text;
  EXPECT_EQ(text, "secret");
}

TEST_F(FileScriptsTest, WalksWithoutFollowingLinks) {
  const std::string root = open_.path().string();
  EXPECT_EQ(value("openspace.walkDirectoryFiles('${ASSETS}/sub', true, true)"),
            Value(Table{{root + "/sub/b.txt"}, {}}));
  const Value all = value("openspace.walkDirectory('${ASSETS}', true, true)");
  ASSERT_TRUE(all.isTable());
  EXPECT_EQ(all.table()->list.size(), 8u);
  EXPECT_EQ(all.table()->list.front(), Value(root + "/a.txt"));
  EXPECT_EQ(value("#openspace.walkDirectoryFiles('${ASSETS}')"), Value(2));
}

TEST_F(FileScriptsTest, StopsInFoldersNestedTooDeeply) {
  std::string deep;
  for (int i = 0; i < 40; ++i) {
    deep += "d/";
  }
  open_.write(deep + "x", "");
  const Result<void> result = engine_.run("openspace.walkDirectory('${ASSETS}', true)", "test");
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().what.find("deeper"), std::string::npos);
}

TEST_F(FileScriptsTest, WritesBelowTheCacheAndNamesTokens) {
  ASSERT_TRUE(
      engine_.run("openspace.writeFile('${CACHE}/new/file.txt', 'x') openspace.setPathToken('${SUB}', "
                  "'${ASSETS}/sub') assert(openspace.readFile('${SUB}/b.txt') == 'beta')",
                  "test"));
  EXPECT_EQ(value("openspace.readFile('${CACHE}/new/file.txt')"), Value("x"));
}

TEST_F(FileScriptsTest, MakesIdentifiers) {
  EXPECT_EQ(value("openspace.makeIdentifier('Viking MDIM 2.1')"), Value("Viking_MDIM_2-1"));
}

TEST(PathTokens, AFolderIsNotBelowOneThatItsNameBeginsWith) {
  EXPECT_TRUE(isBelow("/a/b/c", "/a/b"));
  EXPECT_TRUE(isBelow("/a/b", "/a/b"));
  EXPECT_TRUE(isBelow("/a/b/c", "/a/b/"));
  EXPECT_FALSE(isBelow("/a/bc", "/a/b"));
  EXPECT_FALSE(isBelow("/a", "/a/b"));
}

TEST(PathTokens, UnknownAndUnclosedTokensAreErrors) {
  PathTokens tokens;
  tokens.set("${DATA}", "/data");
  EXPECT_EQ(*tokens.expand("${DATA}/x"), "/data/x");
  EXPECT_EQ(*tokens.expand("${DATA}"), "/data/");
  EXPECT_FALSE(tokens.expand("${NONE}/x"));
  EXPECT_FALSE(tokens.expand("${DATA"));
}

}  // namespace
}  // namespace meridian::assets
