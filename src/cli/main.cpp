// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "vantage/vantage.hpp"

int main() { std::printf("vantage %s\n", vantage::version()); }
