#include "host/assets/file_scripts.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

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

/// A ZIP archive of files that are stored as they are.
std::string zipOf(const std::vector<std::pair<std::string, std::string>>& files) {
  const auto number = [](std::uint64_t value, int bytes) {
    std::string text;
    for (int i = 0; i < bytes; ++i, value >>= 8) {
      text += static_cast<char>(value & 0xff);
    }
    return text;
  };
  const auto checksum = [](const std::string& text) {
    std::uint32_t sum = 0xffffffff;
    for (const unsigned char c : text) {
      sum ^= c;
      for (int bit = 0; bit < 8; ++bit) {
        sum = sum >> 1 ^ (sum & 1 ? 0xedb88320U : 0U);
      }
    }
    return ~sum;
  };
  std::string archive;
  std::string directory;
  for (const auto& [name, text] : files) {
    const std::string common = number(0, 2) + number(0, 2) + number(0, 4) + number(checksum(text), 4) +
                               number(text.size(), 4) + number(text.size(), 4) + number(name.size(), 2) + number(0, 2);
    directory += "PK\1\2" + number(20, 2) + number(20, 2) + common + number(0, 10) + number(archive.size(), 4) + name;
    archive += "PK\3\4" + number(20, 2) + common + name + text;
  }
  const std::string end = "PK\5\6" + number(0, 4) + number(files.size(), 2) + number(files.size(), 2) +
                          number(directory.size(), 4) + number(archive.size(), 4) + number(0, 2);
  return archive + directory + end;
}

TEST_F(FileScriptsTest, UnpacksArchives) {
  open_.write("cache/good.zip", zipOf({{"a.txt", "alpha"}, {"deep/er/b.txt", "beta"}, {"empty/", ""}}));
  ASSERT_TRUE(engine_.run("openspace.unzipFile('${CACHE}/good.zip', '${CACHE}/out-of-zip', true)", "test"));
  EXPECT_EQ(value("openspace.readFile('${CACHE}/out-of-zip/a.txt')"), Value("alpha"));
  EXPECT_EQ(value("openspace.readFile('${CACHE}/out-of-zip/deep/er/b.txt')"), Value("beta"));
  EXPECT_EQ(value("openspace.fileExists('${CACHE}/good.zip')"), Value(false)) << "so it was asked for";
  tokens_.set("SYNC", open_.path() / "sync");
  EXPECT_TRUE(engine_.run("openspace.unzipFile('${SYNC}/never-synchronised.zip', '${CACHE}/x')", "test"));
  open_.write("cache/text.zip", "this is no archive");
  EXPECT_FALSE(engine_.run("openspace.unzipFile('${CACHE}/text.zip', '${CACHE}/x')", "test"));
  open_.write("cache/evil.zip", zipOf({{"../../evil.txt", "out"}}));
  (void)engine_.run("openspace.unzipFile('${CACHE}/evil.zip', '${CACHE}/x')", "test");
  EXPECT_FALSE(std::filesystem::exists(open_.path() / "evil.txt"));
  EXPECT_FALSE(std::filesystem::exists(open_.path() / "cache" / "evil.txt"));
  open_.write("cache/good.zip", zipOf({{"a.txt", "alpha"}}));
  EXPECT_FALSE(engine_.run("openspace.unzipFile('${CACHE}/good.zip', '${ASSETS}/sub')", "test"));
}

TEST_F(FileScriptsTest, ReadsLinesAndTables) {
  open_.write("t.csv", "name,value\r\nMoon,\"1,737\"\n\"a \"\"b\"\"\",\n");
  EXPECT_EQ(value("openspace.readFileLines('t.csv')[2]"), Value("Moon,\"1,737\""));
  EXPECT_EQ(value("openspace.readCSVFile('t.csv')"),
            Value(Table{{Table{{"Moon", "1,737"}, {}}, Table{{"a \"b\"", ""}, {}}}, {}}));
  EXPECT_EQ(value("#openspace.readCSVFile('t.csv', true)"), Value(3));
}

TEST_F(FileScriptsTest, MakesFoldersAndPictures) {
  tokens_.set("TEMPORARY", open_.path() / "cache");
  ASSERT_TRUE(engine_.run("openspace.createDirectory('${CACHE}/one/two')", "test"));
  EXPECT_EQ(value("openspace.directoryExists('${CACHE}/one/two')"), Value(true));
  EXPECT_TRUE(engine_.run("openspace.createDirectory('${ASSETS}/elsewhere')", "test")) << "it only warns";
  EXPECT_FALSE(std::filesystem::exists(open_.path() / "elsewhere"));
  EXPECT_EQ(value("openspace.readFile(openspace.createSingleColorImage('red', { 1, 0, 0.5 }))"),
            Value(std::string("P6 1 1 255\n\xff\0\x80", 14)));
  EXPECT_FALSE(engine_.run("openspace.createSingleColorImage('../red', { 1, 0, 0 })", "test"));
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
