#pragma once

#include "service_fixture.h"

namespace meridian::globebrowsing::test {

/// A picture made by GDAL. `value` gives a band (from 0) at column and row.
struct Picture {
  const char* driver = "PNG";
  int width = 16;
  int height = 8;
  int bands = 3;
  GDALDataType type = GDT_Byte;
  std::vector<std::string> options{};
};
inline Bytes makePicture(const Picture& picture, const std::function<double(int, int, int)>& value,
                         const std::function<void(GDALDataset&)>& finish = {}) {
  GDALAllRegister();
  GDALDriver* memory = GetGDALDriverManager()->GetDriverByName("MEM");
  const GDALDatasetUniquePtr source(
      memory->Create("", picture.width, picture.height, picture.bands, picture.type, nullptr));
  for (int band = 0; band < picture.bands; ++band) {
    std::vector<double> values;
    for (int row = 0; row < picture.height; ++row) {
      for (int column = 0; column < picture.width; ++column) {
        values.push_back(value(band, column, row));
      }
    }
    EXPECT_EQ(source->GetRasterBand(band + 1)->RasterIO(GF_Write, 0, 0, picture.width, picture.height, values.data(),
                                                        picture.width, picture.height, GDT_Float64, 0, 0, nullptr),
              CE_None);
  }
  if (finish) {
    finish(*source);
  }
  char** options = nullptr;
  for (const std::string& option : picture.options) {
    options = CSLAddString(options, option.c_str());
  }
  const std::string path = "/vsimem/picture";
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(picture.driver);
  EXPECT_NE(driver, nullptr) << picture.driver;
  GDALDatasetUniquePtr(driver->CreateCopy(path.c_str(), source.get(), FALSE, options, nullptr, nullptr)).reset();
  CSLDestroy(options);
  vsi_l_offset size = 0;
  GByte* data = VSIGetMemFileBuffer(path.c_str(), &size, TRUE);
  Bytes bytes(data, data + size);
  VSIFree(data);
  VSIUnlink((path + ".aux.xml").c_str());
  return bytes;
}

}  // namespace meridian::globebrowsing::test
