// Is every row of mine.csv within the tolerance of the reference?
//     ./example euler-generic.csv mine.csv 1e-10
// The columns of mine.csv may stand in any order; its rows are at the times of the reference.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

using Columns = std::map<std::string, std::vector<double>>;

Columns read(const char* path) {
  std::ifstream file(path);
  std::string line, cell;
  std::vector<std::string> names;
  std::getline(file, line);
  for (std::istringstream cells(line); std::getline(cells, cell, ',');) names.push_back(cell);
  Columns columns;
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    for (const auto& name : names)
      columns[name].push_back(std::getline(cells, cell, ',') ? std::stod(cell) : NAN);
  }
  return columns;
}

const std::vector<double>& column(const Columns& columns, const std::string& name, const char* path) {
  if (columns.count(name)) return columns.at(name);
  std::cerr << "expected a column " << name << ", got none in " << path << "\n";
  std::exit(2);
}

int main(int count, char** argument) {
  if (count != 4) return std::cerr << "usage: example REFERENCE MINE TOLERANCE\n", 2;
  const Columns exact = read(argument[1]), mine = read(argument[2]);
  const double tolerance = std::stod(argument[3]);
  const std::size_t rows = column(exact, "t", argument[1]).size();
  bool within = rows > 0;
  for (const std::string vector : {"t", "w", "x", "y", "r", "c"}) {
    std::vector<double> error(rows), size(rows);
    for (const auto& [name, values] : exact) {
      if (name.substr(0, 1) != vector || name == "radius") continue;
      const std::vector<double>& answers = column(mine, name, argument[2]);
      for (std::size_t k = 0; k < rows; ++k) {
        error[k] = std::hypot(error[k], (k < answers.size() ? answers[k] : NAN) - values[k]);
        size[k] = std::hypot(size[k], values[k]);
      }
    }
    const double largest = *std::max_element(size.begin(), size.end());
    const double scale = largest > 0 ? largest : 1;
    for (std::size_t k = 0; k < rows; ++k) {
      if (error[k] <= tolerance * scale) continue;  // NaN is not
      std::cout << vector << " row " << k << ": off by " << error[k] / scale << "\n";
      within = false;
    }
  }
  return within ? 0 : 1;
}
