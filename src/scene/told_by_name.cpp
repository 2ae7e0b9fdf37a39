// SPDX-License-Identifier: Apache-2.0
#include "scene/told_by_name.hpp"

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <string_view>

#include "core/text.hpp"

namespace vantage {
namespace {

class Words {
 public:
  explicit Words(const std::string& name) : low_(lower_case(name)) {}

  bool has(std::initializer_list<std::string_view> words) const {
    return std::ranges::any_of(words, [&](std::string_view word) { return low_.find(word) != std::string::npos; });
  }
  // Between what are no letters.
  bool has_whole(std::initializer_list<std::string_view> words) const {
    return std::ranges::any_of(words, [&](std::string_view word) {
      for (std::size_t at = low_.find(word); at != std::string::npos; at = low_.find(word, at + 1))
        if ((at == 0 || !letter(at - 1)) && !letter(at + word.size())) return true;
      return false;
    });
  }

 private:
  bool letter(std::size_t at) const {
    return at < low_.size() && (std::isalpha(static_cast<unsigned char>(low_[at])) || (low_[at] & 0x80));
  }
  std::string low_;
};

}  // namespace

bool names_a_door(const std::string& name) {
  const Words words(name);
  if (words.has({"outdoor", "indoor", "cabinet", "cupboard", "wardrobe", "closet", "fridge", "schrank", "armoire",
                 "armario", "armadio", "kast", "шкаф", "柜", "棚"}))
    return false;
  return words.has({"door", "tür",   "TÜR",  "tuer", "puerta", "deur", "drzwi", "dveř", "dvere",   "двер",      "Двер",
                    "ДВЕР", "πόρτα", "θύρα", "门",   "門",     "ドア", "扉",    "문",   "rolltor", "schiebetor"}) ||
         words.has_whole({"porte",      "portes",  "porta",    "porte-fenêtre", "ovi",      "dør",      "dörr",
                          "kapı",       "ajtó",    "ușă",      "врата",         "gate",     "gates",    "tor",
                          "tore",       "portail", "portón",   "cancello",      "poort",    "brama",    "ворота",
                          "shutter",    "roller",  "persiana", "saracinesca",   "serranda", "rolladen", "rollladen",
                          "rollgitter", "rolluik", "roleta"});
}

bool names_a_leaf(const std::string& name) {
  return names_a_door(name) ||
         Words(name).has_whole({"leaf", "leaves", "sliding", "slider", "turnstile", "flügel", "fluegel", "torflügel",
                                "vantail", "battant", "anta", "hoja", "skrzydło", "створка"});
}

bool names_water(const std::string& name) {
  return Words(name).has_whole({"water",
                                "watersurface",
                                "waterlevel",
                                "wasser",
                                "wasserspiegel",
                                "wasserfläche",
                                "wasserflaeche",
                                "wasseroberfläche",
                                "gewässer",
                                "river",
                                "fluss",
                                "lake",
                                "pond",
                                "teich",
                                "rivière",
                                "eau",
                                "agua",
                                "água",
                                "río",
                                "acqua",
                                "fiume",
                                "woda",
                                "rzeka",
                                "voda",
                                "вода",
                                "река",
                                "水",
                                "水面"});
}

}  // namespace vantage
