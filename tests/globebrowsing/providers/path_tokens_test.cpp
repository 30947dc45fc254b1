#include "globebrowsing/providers/path_tokens.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "provider_fixture.h"

namespace meridian::globebrowsing {
namespace {

using ::testing::HasSubstr;

std::optional<std::filesystem::path> folderOf(std::string_view name) {
  if (name == "ASSETS") {
    return "/a";
  }
  if (name == "ODD") {
    return "/b & <c>/";
  }
  // Whatever a script may call its tokens, GDAL's words are GDAL's.
  return name == "x" || name == "OpenSpaceTimeId" || name == "mine" ? std::optional<std::filesystem::path>("/own")
                                                                    : std::nullopt;
}

TEST(PathTokens, AreReplacedWhereverTheyStand) {
  for (const auto& [text, replaced] : {
           std::pair("${ASSETS}/x.tif", "/a/x.tif"),
           std::pair("${ASSETS}x.tif", "/a/x.tif"),
           std::pair("${ASSETS}", "/a"),
           std::pair("${ODD}/x.tif", "/b & <c>/x.tif"),
           std::pair("${mine}/x.tif", "/own/x.tif"),
           std::pair("/vsizip/${ASSETS}/x.zip/y.tif", "/vsizip//a/x.zip/y.tif"),
           std::pair("NETCDF:${ASSETS}/x.nc:height", "NETCDF:/a/x.nc:height"),
           std::pair("${ASSETS}/${OpenSpaceTimeId}/${x}.png", "/a/${OpenSpaceTimeId}/${x}.png"),
           std::pair("https://s/${z}/${y}/${x}.png?k=${KEY}", "https://s/${z}/${y}/${x}.png?k=${KEY}"),
           std::pair("<GDAL_WMS><ServerUrl>https://s/${version}/${x}.${format}</ServerUrl>"
                     "<Cache><Path>${ODD}/wms</Path></Cache></GDAL_WMS>",
                     "<GDAL_WMS><ServerUrl>https://s/${version}/${x}.${format}</ServerUrl>"
                     "<Cache><Path>/b &amp; &lt;c&gt;/wms</Path></Cache></GDAL_WMS>"),
           std::pair("${NOPE}/x", "${NOPE}/x"),
           std::pair("a${ASSETS", "a${ASSETS"),
           std::pair("${${ASSETS}}/x", "${/a}/x"),
           std::pair("$ASSETS {x}", "$ASSETS {x}"),
           std::pair("", ""),
       }) {
    EXPECT_EQ(withTokensReplaced(std::string(text), folderOf), replaced);
    EXPECT_EQ(withTokensReplaced(std::string(text), {}), text);
  }
}

TEST(PathTokens, AreReplacedInThePathsOfATableOnly) {
  const Value table = tableOf({{"Name", "${ASSETS}"},
                               {"Folder", tableOf({{"Folder", "${ASSETS}/days"}, {"Format", "${ASSETS}%Y"}})},
                               {"LevelTileProviders", listOf({tableOf({{"FilePath", "${ASSETS}/l.tif"}})})}});
  const Value replaced = withTokensReplaced(table, folderOf);
  EXPECT_EQ(*replaced.find("Name")->string(), "${ASSETS}");
  EXPECT_EQ(*replaced.find("Folder")->find("Folder")->string(), "/a/days");
  EXPECT_EQ(*replaced.find("Folder")->find("Format")->string(), "${ASSETS}%Y");
  EXPECT_EQ(*replaced.find("LevelTileProviders")->table()->list[0].find("FilePath")->string(), "/a/l.tif");
}

TEST(PathTokens, ThoseThatNobodyKnowsAreNamed) {
  for (const char* text : {"/data/${NOPE}/x.tif", "${NOPE}/${OpenSpaceTimeId}.tif", "/vsizip/${NOPE}/x.zip",
                           "<VRTDataset><SourceFilename relativeToVRT=\"0\"> ${NOPE}/x.tif</SourceFilename>"}) {
    const Result<void> checked = checkTokens(text, "here");
    ASSERT_FALSE(checked) << text;
    EXPECT_EQ(checked.error().what, "unknown path token ${NOPE}");
    EXPECT_EQ(checked.error().where, "here");
  }
  for (const char* text :
       {"/data/x.tif", "/data/${x}.tif", "https://s/${KEY}/x", "WMS:https://s?${KEY}", "${}", "${NOPE", "${Nope}/x",
        "<GDAL_WMS><ServerUrl>https://s/${KEY}/${x}</ServerUrl></GDAL_WMS>", "${OpenSpaceTimeId}.png"}) {
    EXPECT_TRUE(checkTokens(text, "here")) << text;
  }
}

TEST(PathTokens, AProviderWhosePathHasOneIsNotUsable) {
  const TemporaryFolder folder("tokens");
  const auto temporal = [](Fields fields) {
    fields["Type"] = "TemporalTileProvider";
    return fields;
  };
  const Value times = tableOf({{"Start", "2004-01-01"}, {"End", "2005-01-01"}});
  const auto prototyped = [&](const char* prototype) {
    return temporal(
        {{"Prototyped",
          tableOf({{"Time", times}, {"TemporalResolution", "1d"}, {"TimeFormat", "YYYY"}, {"Prototype", prototype}})}});
  };
  const Value here = tableOf({{"Folder", "."}, {"Format", "%Y"}});
  for (const auto& [fields, key] : std::vector<std::pair<Fields, std::string>>{
           {{{"FilePath", "${NOPE}/x.tif"}}, "FilePath"},
           {{{"FilePath", "<VRTDataset><SourceFilename>${NOPE}/x</SourceFilename></VRTDataset>"}}, "FilePath"},
           {{{"Type", "SingleImageProvider"}, {"FilePath", "${NOPE}/x.png"}}, "FilePath"},
           {{{"Type", "ImageSequenceTileProvider"}, {"FolderPath", "${NOPE}"}}, "FolderPath"},
           {{{"Type", "ColorRelief"}, {"ColorRampFile", "${NOPE}/x"}}, "ColorRampFile"},
           {temporal({{"Folder", tableOf({{"Folder", "${NOPE}"}, {"Format", "%Y"}})}}), "Folder.Folder"},
           {temporal({{"Folder", here}, {"Colormap", "${NOPE}/x.png"}}), "Colormap"},
           {prototyped("${NOPE}/${OpenSpaceTimeId}.tif"), "Prototyped.Prototype"},
           {prototyped("<A><B>${NOPE}/${OpenSpaceTimeId}.tif</B></A>"), "Prototyped.Prototype"}}) {
    const auto made = makeProvider(requestFor(fields, folder.path()));
    ASSERT_TRUE(made) << made.error().message();
    for (const Result<void>& told : {(*made)->check(), (*made)->open()}) {
      ASSERT_FALSE(told) << key;
      EXPECT_THAT(told.error().message(), HasSubstr("." + key + ": unknown path token ${NOPE}"));
    }
  }
}

TEST(PathTokens, AFileThatIsCalledLikeOneIsAFile) {
  const TemporaryFolder folder("tokens");
  std::ofstream(folder.path() + "/${NOPE}.tif") << "x";
  const auto made = makeProvider(requestFor({{"FilePath", "${NOPE}.tif"}}, folder.path()));
  ASSERT_TRUE(made);
  EXPECT_TRUE((*made)->check());
}

}  // namespace
}  // namespace meridian::globebrowsing
