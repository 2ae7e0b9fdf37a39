// SPDX-License-Identifier: Apache-2.0
#include "scene/told_by_name.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/text.hpp"

namespace vantage {
namespace {

class Words {
 public:
  explicit Words(const std::string& name) : name_(name), low_(lower_case(name)) {}

  bool has(std::initializer_list<std::string_view> words) const {
    return std::ranges::any_of(words, [&](std::string_view word) { return low_.find(word) != std::string::npos; });
  }
  // Returns the words in lower case.
  std::vector<std::string> all() const {
    std::vector<std::string> words;
    bool goes_on = false;
    for (std::size_t at = 0; at < low_.size(); ++at) {
      if (letter(at) && (!goes_on || begins(at))) words.emplace_back();
      goes_on = letter(at);
      if (goes_on) words.back() += low_[at];
    }
    return words;
  }
  // Finds a whole word: between other characters than letters, or set off by its capital, as in CellGate.
  bool has_whole(std::initializer_list<std::string_view> words) const { return has_whole(std::span(words)); }
  bool has_whole(std::span<const std::string_view> words) const {
    return std::ranges::any_of(words, [&](std::string_view word) {
      for (std::size_t at = low_.find(word); at != std::string::npos; at = low_.find(word, at + 1))
        if ((!letter(at - 1) || begins(at)) && (!letter(at + word.size()) || begins(at + word.size()))) return true;
      return false;
    });
  }

 private:
  bool letter(std::size_t at) const {
    return at < low_.size() && (std::isalpha(static_cast<unsigned char>(low_[at])) || (low_[at] & 0x80));
  }
  // Returns true at a capital after a small letter.
  bool begins(std::size_t at) const {
    return at > 0 && at < name_.size() && std::isupper(static_cast<unsigned char>(name_[at])) &&
           std::islower(static_cast<unsigned char>(name_[at - 1]));
  }
  const std::string& name_;
  std::string low_;
};

constexpr auto kWater = std::to_array<std::string_view>({"water",
                                                         "watersurface",
                                                         "waterlevel",
                                                         "river",
                                                         "lake",
                                                         "pond",
                                                         "wasser",
                                                         "wasserspiegel",
                                                         "wasserfläche",
                                                         "wasserflaeche",
                                                         "wasseroberfläche",
                                                         "wasseroberflaeche",
                                                         "gewässer",
                                                         "fluss",
                                                         "teich",
                                                         "wateroppervlak",
                                                         "vatten",
                                                         "vattenyta",
                                                         "vand",
                                                         "vandspejl",
                                                         "vann",
                                                         "vesi",
                                                         "eau",
                                                         "rivière",
                                                         "étang",
                                                         "agua",
                                                         "água",
                                                         "río",
                                                         "lago",
                                                         "acqua",
                                                         "fiume",
                                                         "woda",
                                                         "rzeka",
                                                         "jezioro",
                                                         "voda",
                                                         "hladina",
                                                         "вода",
                                                         "река",
                                                         "озеро",
                                                         "Вода",
                                                         "Река",
                                                         "Озеро",
                                                         "Étang",
                                                         "水",
                                                         "水面"});
// Words that mean water alone, but not beside others: a sea container, a stream of goods.
constexpr auto kAlone = std::to_array<std::string_view>(
    {"sea",   "ocean",  "lagoon",   "stream", "creek",  "brook",  "meer", "ozean",  "bach",   "stausee", "mer",
     "océan", "lagune", "ruisseau", "mar",    "océano", "oceano", "mare", "laguna", "arroyo", "zee",     "oceaan",
     "hav",   "havet",  "meri",     "morze",  "moře",   "море",   "Море", "океан",  "Океан",  "海",      "海面"});
constexpr auto kBesideWater = std::to_array<std::string_view>(
    {"m", "mat", "material", "mtl", "site", "surface", "plane", "level", "pool", "clear", "deep", "blue"});

}  // namespace

bool names_a_door(const std::string& name) {
  const Words words(name);
  if (words.has({"outdoor", "indoor", "cabinet", "cupboard", "wardrobe", "closet", "fridge", "schrank", "armoire",
                 "armario", "armadio", "kast", "шкаф", "柜", "棚"}))
    return false;
  return words.has({"door", "tür",   "TÜR",  "tuer", "puerta", "deur", "drzwi", "dveř", "dvere",   "двер",      "Двер",
                    "ДВЕР", "πόρτα", "θύρα", "门",   "門",     "ドア", "扉",    "문",   "rolltor", "schiebetor"}) ||
         words.has_whole({"porte",       "portes",   "porta",     "porte-fenêtre", "ovi",        "dør",     "dörr",
                          "kapı",        "ajtó",     "ușă",       "врата",         "gate",       "gates",   "tor",
                          "tore",        "portail",  "portillon", "furtka",        "wicket",     "pforte",  "portón",
                          "cancello",    "poort",    "brama",     "ворота",        "shutter",    "roller",  "persiana",
                          "saracinesca", "serranda", "rolladen",  "rollladen",     "rollgitter", "rolluik", "roleta"});
}

bool names_a_leaf(const std::string& name) {
  return names_a_door(name) ||
         Words(name).has_whole({"leaf", "leaves", "sliding", "slider", "turnstile", "flügel", "fluegel", "torflügel",
                                "vantail", "battant", "anta", "hoja", "skrzydło", "створка"});
}

bool names_a_ceiling(const std::string& name) {
  const Words words(name);
  // Many languages use one word for ceiling and slab, so only suspended ceilings are listed.
  return words.has({"ceiling", "plafond", "soffitto", "sufit", "unterdecke", "akustikdecke", "rasterdecke",
                    "deckensegel", "abhangdecke", "abgehängte", "abgehaengte", "falso techo", "falso_techo",
                    "forro_falso", "loftplade", "undertak", "подвесной потолок", "天井", "天花"}) &&
         !words.has({"above", "slab"});
}

bool names_water(const std::string& name) { return Words(name).has_whole(kWater) || is_water(name); }

// Rocks, tiles and paints are also named after rivers and lakes.
bool is_water(const std::string& material) {
  bool any = false;
  for (const std::string& word : Words(material).all()) {
    const bool water =
        std::ranges::find(kWater, word) != std::end(kWater) || std::ranges::find(kAlone, word) != std::end(kAlone);
    any = any || water;
    if (!water && std::ranges::find(kBesideWater, word) == std::end(kBesideWater)) return false;
  }
  return any;
}

}  // namespace vantage
