// SPDX-License-Identifier: Apache-2.0
// make_site NAME FILE.glb [--mm] [--z-up] [--utm]: writes one of the reference sites.
#include <exception>
#include <iostream>
#include <string>

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
    std::cerr << "usage: make_site office|house|street|plant FILE.glb [--mm] [--z-up] [--utm]\n";
    return 2;
  }
  try {
    write_site(make_site(argv[1], variant), variant, argv[2]);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "make_site: " << error.what() << "\n";
    return 1;
  }
}
