// Whom the data are to be credited to that are seen.
#include <gmock/gmock.h>

#include "globe_fixture.h"

namespace meridian::globebrowsing {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class AttributionTest : public GlobeTest {
 protected:
  std::vector<std::string> shown() {
    frame();
    std::vector<std::string_view> found;
    for (const auto& [name, renderable] : host_->renderables) {
      renderable->addAttributions(found);
    }
    return {found.begin(), found.end()};
  }
};

TEST_F(AttributionTest, NamesEachOfTheLayersThatAreSeenOnce) {
  RenderableGlobe& globe =
      addGlobe({{"ColorLayers", listOf({solidLayer("A", {1, 0, 0}, {{"Attribution", "Me"}}),
                                        solidLayer("B", {0, 1, 0}, {{"Attribution", "You\n and <a href='x'>them</a>"}}),
                                        solidLayer("C", {0, 0, 1}, {{"Attribution", "Others"}, {"Enabled", false}})})},
                {"Overlays", listOf({solidLayer("D", {1, 1, 1}, {{"Attribution", "Me"}})})}});
  EXPECT_THAT(shown(), ElementsAre("Me", "You and them"));
  LayerGroup& colours = globe.layers().group(LayerGroupId::ColorLayers);
  colours.find("B")->opacity.put(0.0);
  colours.find("C")->enabled.put(true);
  EXPECT_THAT(shown(), ElementsAre("Me", "Others"));
  look(0.1, 0.2, 1.5e7);
  view_.cameraFromModel = glm::rotate(glm::dmat4(1.0), 3.0, glm::dvec3(0, 1, 0)) * view_.cameraFromModel;
  EXPECT_THAT(shown(), IsEmpty()) << "it is behind the camera";
  look(0.1, 0.2, 1.5e7);
  EXPECT_THAT(shown(), ElementsAre("Me", "Others"));
  globe.enabled.put(false);
  EXPECT_THAT(shown(), IsEmpty());
}

TEST_F(AttributionTest, ComesFromTheDataWhereTheAssetSaysNothing) {
  const std::string file = uniformRaster("c.tif", {10, 20, 30});
  {
    const GDALDatasetUniquePtr dataset(GDALDataset::Open(file.c_str(), GDAL_OF_UPDATE));
    dataset->SetMetadataItem("TIFFTAG_COPYRIGHT", "(c) The  raster");
  }
  RenderableGlobe& globe = addGlobe({{"ColorLayers", listOf({fileLayer("A", file)})},
                                     {"Overlays", listOf({fileLayer("B", file, {{"Attribution", "Mine"}})})}});
  ASSERT_TRUE(settle());
  EXPECT_THAT(shown(), ElementsAre("(c) The raster", "Mine"));
  const Layer* layer = globe.layers().group(LayerGroupId::ColorLayers).find("A");
  EXPECT_EQ(layer->attribution.get(), "(c) The raster");
  EXPECT_FALSE(globe.layers().propertyAt("ColorLayers.A.Attribution")->set(Value("Somebody")));
}

}  // namespace
}  // namespace meridian::globebrowsing
