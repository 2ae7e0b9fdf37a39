// SPDX-License-Identifier: Apache-2.0
#include "import/floor_plan/layers.hpp"

#include <fnmatch.h>

#include <algorithm>
#include <initializer_list>
#include <string_view>

namespace vantage::floor_plan {
namespace {

using Words = std::initializer_list<std::string_view>;

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (static_cast<unsigned char>(c) & 0x80) != 0;  // beyond ASCII: a letter
}

bool has(const std::string& name, Words words) {
  return std::ranges::any_of(words, [&](std::string_view word) { return name.find(word) != std::string::npos; });
}

// Finds a whole word, with no letter before or after it.
bool has_whole(const std::string& name, Words words) {
  return std::ranges::any_of(words, [&](std::string_view word) {
    for (std::size_t at = name.find(word); at != std::string::npos; at = name.find(word, at + 1))
      if ((at == 0 || !is_letter(name[at - 1])) &&
          (at + word.size() == name.size() || !is_letter(name[at + word.size()])))
        return true;
    return false;
  });
}

bool names_annotation(const std::string& n) {
  return has(n, {"dim",   "bema",  "maße",     "masse",    "cotas",  "cotat", "quote",   "maat",    "text",   "txt",
                 "anno",  "note",  "iden",     "grid",     "axis",   "axes",  "achse",   "raster",  "title",  "border",
                 "frame", "sheet", "viewport", "defpoint", "legend", "north", "elec",    "hvac",    "light",  "leucht",
                 "roof",  "dach",  "ceil",     "clng",     "landsc", "topo",  "contour", "parking", "размер", "текст",
                 "оси",   "标注",  "尺寸",     "轴",       "文字",   "寸法"}) ||
         has_whole(n,
                   {"tag", "tags", "cota", "cotes", "axe", "assi", "ejes", "logo", "hidden", "scale", "tree", "trees"});
}

bool names_a_door(const std::string& n) {
  return has(n, {"door", "tür", "tuer", "tueren", "puerta", "deur", "drzwi", "dveř", "dvere", "двер", "πόρτα", "θύρα",
                 "门", "門", "ドア", "扉", "문"}) ||
         has_whole(n, {"porte", "portes", "porta", "porte", "ovi", "ovet", "dør", "dører", "dörr", "dörrar", "kapı",
                       "ajtó", "ușă", "врата"});
}

bool names_a_window(const std::string& n) {
  return has(n, {"window",  "windw",     "fenster", "fenêtre",  "fenetre", "ventana", "janela",
                 "finestr", "serrament", "fönster", "foenster", "vindu",   "ikkun",   "okn",
                 "окн",     "glaz",      "窗",      "窓",       "창",      "παράθυρο"}) ||
         has_whole(n, {"win", "wind", "wdw", "raam", "ramen", "glas", "glass", "pencere", "ablak"});
}

bool names_furniture(const std::string& n) {
  return has(n,
             {"furn",  "möb",    "moeb",    "mobil",   "mueble", "meuble", "meubel",  "arred",    "nábyt",   "мебел",
              "家具",  "가구",   "table",   "chair",   "sofa",   "couch",  "desk",    "wardrobe", "cabinet", "cupboard",
              "casew", "toilet", "shower",  "bathtub", "sanit",  "plumb",  "fixture", "basin",    "stove",   "fridge",
              "tisch", "stuhl",  "schrank", "wanne",   "dusche", "lavabo", "shelf",   "regal",    "洁具",    "衛生"}) ||
         has_whole(n, {"bed", "beds", "bett", "wc", "sink", "bath", "lit", "cama", "letto", "mesa", "silla", "oven",
                       "equip", "eqpm"});
}

bool names_a_stair(const std::string& n) {
  return has(n, {"stair", "strs", "trepp", "escal", "schody", "лестн", "楼梯", "階段", "계단", "trappe"}) ||
         has_whole(n, {"trap", "trappa", "scala", "scale"});
}

bool names_a_wall(const std::string& n) {
  return has(n,
             {"wall",   "wand",    "wände",  "waende",  "mauer",   "muro",      "parede",  "paret",  "muur",  "vägg",
              "vaegg",  "væg",     "vegg",   "seinä",   "ścian",   "scian",     "stěn",    "стен",   "τοίχ",  "墙",
              "牆",     "壁",      "벽",     "cloison", "tabique", "partition", "tramezz", "column", "säule", "saeule",
              "stütze", "stuetze", "pillar", "pilar",   "poteau",  "kolom",     "колонн",  "柱"}) ||
         has_whole(n, {"mur", "murs", "prtn", "colu", "cols", "col", "seina", "fal", "falak", "duvar", "zid", "steny",
                       "stena"});
}

}  // namespace

std::string lower_case(const std::string& text) {
  std::string out = text;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto byte = static_cast<unsigned char>(out[i]);
    if (byte >= 'A' && byte <= 'Z') out[i] = static_cast<char>(byte - 'A' + 'a');
    if (byte < 0xC3 || byte > 0xD1 || i + 1 >= out.size()) continue;
    const auto next = static_cast<unsigned char>(out[i + 1]);
    // Decodes two bytes of UTF-8.
    unsigned code = ((byte & 0x1FU) << 6) | (next & 0x3FU);
    if (code >= 0xC0 && code <= 0xDE && code != 0xD7)
      code += 0x20;
    else if (code >= 0x391 && code <= 0x3A9)
      code += 0x20;
    else if (code >= 0x410 && code <= 0x42F)
      code += 0x20;
    else if (code >= 0x100 && code <= 0x137 && code % 2 == 0)
      code += 1;
    else if (code >= 0x139 && code <= 0x148 && code % 2 == 1)
      code += 1;
    else if (code >= 0x14A && code <= 0x177 && code % 2 == 0)
      code += 1;
    out[i] = static_cast<char>(0xC0 | (code >> 6));
    out[i + 1] = static_cast<char>(0x80 | (code & 0x3F));
    ++i;
  }
  return out;
}

Kind kind_of(const std::string& name) {
  const std::string n = lower_case(name);
  if (names_annotation(n)) return Kind::annotation;
  if (names_a_door(n)) return Kind::door;
  if (names_a_window(n)) return Kind::window;
  if (names_furniture(n)) return Kind::furniture;
  if (names_a_stair(n)) return Kind::stair;
  return names_a_wall(n) ? Kind::wall : Kind::other;
}

bool names_another_view(const std::string& text) {
  const std::string n = lower_case(text);
  return has(n, {"elevation",       "ansicht",   "facade",   "façade",  "fassade",   "fachada", "alzado",
                 "alçado",          "prospetto", "elevação", "gevel",   "fasad",     "elewacj", "фасад",
                 "разрез",          "立面",      "剖面",     "立面図",  "roof plan", "dachauf", "dachdr",
                 "plan de toiture", "schnitt",   "coupe",    "sezione", "doorsnede"}) ||
         has_whole(n, {"section", "corte", "snitt", "przekrój", "toiture", "copertura"});
}

bool matches(const std::string& name, const std::string& pattern) {
  return fnmatch(lower_case(pattern).c_str(), lower_case(name).c_str(), 0) == 0;
}

}  // namespace vantage::floor_plan
