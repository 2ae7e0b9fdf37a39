// SPDX-License-Identifier: Apache-2.0
// make_site NAME FILE.glb [--mm] [--z-up] [--utm]: writes one of the reference sites. make_site SEED FILE.glb writes a
// random one.
#include <algorithm>
#include <cctype>
#include <exception>
#include <iostream>
#include <string>

#include "sites/random_site.hpp"
#include "sites/site.hpp"

int main(int argc, char** argv) {
  using namespace vantage::test;
  Variant variant;
  bool good = argc >= 3;
  for (int i = 3; i < argc; ++i) {
    const std::string option = argv[i];
    bool* flag = option == "--mm"     ? &variant.millimetres
                 : option == "--z-up" ? &variant.z_up
                 : option == "--utm"  ? &variant.utm
                                      : nullptr;
    if (flag)
      *flag = true;
    else
      good = false;
  }
  if (!good) {
    std::cerr << "usage: make_site office|house|street|plant FILE.glb [--mm] [--z-up] [--utm]\n"
                 "       make_site SEED FILE.glb\n";
    return 2;
  }
  try {
    const std::string name = argv[1];
    if (std::ranges::all_of(name, [](unsigned char c) { return std::isdigit(c) != 0; })) {
      const RandomSite random = make_random_site(std::stoull(name));
      std::cout << random.told << "\n";
      write_site(random, argv[2]);
      return 0;
    }
    write_site(make_site(argv[1], variant), variant, argv[2]);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "make_site: " << error.what() << "\n";
    return 1;
  }
}
