#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "support/shared_data.h"

namespace meridian::test {

/// The answers of CSPICE that the shared data holds: one JSON object a line, with no nesting but number lists.
inline std::filesystem::path goldenFolder() {
  return sharedData("spice/golden");
}

inline std::vector<std::string> goldenLines(const std::string& file) {
  std::ifstream stream(goldenFolder() / file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

/// What stands after `"key": `; empty without it.
inline std::string goldenField(const std::string& line, const std::string& key) {
  const std::string mark = "\"" + key + "\": ";
  const std::size_t start = line.find(mark);
  if (start == std::string::npos) {
    return {};
  }
  const std::size_t from = start + mark.size();
  const char first = line[from];
  if (first == '"') {
    return line.substr(from + 1, line.find('"', from + 1) - from - 1);
  }
  const std::size_t end = line.find_first_of(first == '[' ? "]" : ",}", from);
  return first == '[' ? line.substr(from + 1, end - from - 1) : line.substr(from, end - from);
}

inline std::vector<double> goldenNumbers(const std::string& line, const std::string& key) {
  std::string text = goldenField(line, key);
  for (char& c : text) {
    c = c == ',' ? ' ' : c;
  }
  std::istringstream stream(text);
  std::vector<double> numbers;
  for (double number = 0.0; stream >> number;) {
    numbers.push_back(number);
  }
  return numbers;
}

}  // namespace meridian::test
