// SPDX-License-Identifier: Apache-2.0
#include "import/floor_plan/labels.hpp"

#include <iconv.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <initializer_list>
#include <string_view>
#include <vector>

#include "core/utf8.hpp"

namespace vantage::floor_plan {
namespace {

void append_utf8(std::string& out, std::uint32_t code) {
  if (code < 0x20) return;
  if (code < 0x80) {
    out += static_cast<char>(code);
  } else if (code < 0x800) {
    out += static_cast<char>(0xC0 | (code >> 6));
    out += static_cast<char>(0x80 | (code & 0x3F));
  } else {
    out += static_cast<char>(0xE0 | (code >> 12));
    out += static_cast<char>(0x80 | ((code >> 6) & 0x3F));
    out += static_cast<char>(0x80 | (code & 0x3F));
  }
}

// Decodes text of $DWGCODEPAGE, under its name in iconv: ANSI_1251 is CP1251.
std::string decoded(const std::string& text, const std::string& code_page) {
  if (is_utf8(text)) return text;
  const std::size_t number = code_page.find_first_of("0123456789");
  const std::string page = number == std::string::npos ? "CP1252" : "CP" + code_page.substr(number);
  const iconv_t convert = iconv_open("UTF-8", page.c_str());
  if (convert == reinterpret_cast<iconv_t>(-1)) return to_utf8(text);
  std::string out(4 * text.size(), '\0'), in = text;
  char *from = in.data(), *to = out.data();
  std::size_t left = in.size(), free = out.size();
  const bool sound = iconv(convert, &from, &left, &to, &free) != static_cast<std::size_t>(-1);
  iconv_close(convert);
  if (!sound) return to_utf8(text);
  out.resize(out.size() - free);
  return out;
}

// Decodes \U+00E9, and %%nnn of old files.
std::string without_escapes(const std::string& text) {
  std::string out;
  const auto digits = [&](std::size_t at, std::size_t count, auto is_digit) {
    return at + count <= text.size() && std::all_of(text.begin() + static_cast<std::ptrdiff_t>(at),
                                                    text.begin() + static_cast<std::ptrdiff_t>(at + count),
                                                    [&](unsigned char c) { return is_digit(c) != 0; });
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text.compare(i, 3, "\\U+") == 0 && digits(i + 3, 4, [](int c) { return std::isxdigit(c); })) {
      append_utf8(out, static_cast<std::uint32_t>(std::stoul(text.substr(i + 3, 4), nullptr, 16)));
      i += 6;
    } else if (text.compare(i, 2, "%%") == 0 && i + 2 < text.size()) {
      const char what = static_cast<char>(std::tolower(static_cast<unsigned char>(text[i + 2])));
      if (digits(i + 2, 3, [](int c) { return std::isdigit(c); })) {
        append_utf8(out, static_cast<std::uint32_t>(std::stoul(text.substr(i + 2, 3))));
        i += 4;
      } else {
        if (what == 'd') out += "\u00B0";
        if (what == 'c') out += "\u00D8";
        if (what == 'p') out += "\u00B1";
        i += 2;
      }
    } else {
      out += text[i];
    }
  }
  return out;
}

// Removes formatting such as {\fArial|b0;Living \Proom}. Most codes, a backslash and a letter, end with a semicolon.
std::string without_formatting(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '{' || c == '}') continue;
    if (c == '^' && i + 1 < text.size()) {  // a control character
      out += ' ';
      ++i;
    } else if (c != '\\' || i + 1 >= text.size()) {
      out += c;
    } else if (const char code = text[++i]; code == 'P' || code == 'X' || code == 'N' || code == '~') {
      out += ' ';
    } else if (code == '\\' || code == '{' || code == '}') {
      out += code;
    } else if (std::string_view("ACcFfHhQTWpS").find(code) != std::string_view::npos) {
      const std::size_t end = text.find(';', i);
      if (end == std::string::npos) continue;
      if (code == 'S') out += text.substr(i + 1, end - i - 1);  // a fraction
      i = end;
    }  // else one that stands alone: \L, \O, \K
  }
  return out;
}

std::string on_one_line(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const bool blank = static_cast<unsigned char>(c) <= ' ' || c == '\x7F';
    if (!blank)
      out += c;
    else if (!out.empty() && out.back() != ' ')
      out += ' ';
  }
  while (!out.empty() && out.back() == ' ') out.pop_back();
  return out;
}

}  // namespace

std::string plain_name(const std::string& name, const std::string& code_page) {
  return on_one_line(without_escapes(decoded(name, code_page)));
}

std::string plain_text(const std::string& text, const std::string& code_page) {
  return on_one_line(without_formatting(without_escapes(decoded(text, code_page))));
}

int stair_way(const std::string& text) {
  constexpr std::size_t kLongestOther = 2;  // as in DN 16R; names of rooms have longer words
  std::vector<std::string> words(1);
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80 && std::isalpha(byte) == 0) {
      if (!words.back().empty()) words.emplace_back();
    } else {
      words.back() += static_cast<char>(std::tolower(byte));
    }
  }
  if (words.back().empty()) words.pop_back();
  if (words.empty()) return 0;
  for (std::size_t k = 1; k < words.size(); ++k)
    if (words[k].size() > kLongestOther) return 0;
  const auto is = [&](std::initializer_list<std::string_view> wanted) {
    return std::ranges::find(wanted, words.front()) != wanted.end();
  };
  if (is({"up", "auf", "hoch", "sube", "subir", "monte", "haut", "sale", "salita", "sobe", "op", "upp"})) return 1;
  return is({"dn", "down", "ab", "runter", "baja", "bajar", "descente", "bas", "scende", "desce", "ned"}) ? -1 : 0;
}

Label::Kind label_of(const std::string& text) {
  std::size_t letters = 0, digits = 0, row = 0, longest = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool letter = std::isalpha(byte) != 0 || byte >= 0xC3;  // the first byte of a letter beyond ASCII
    letters += letter;
    digits += std::isdigit(byte) != 0;
    row = letter || (byte & 0xC0) == 0x80 ? row + 1 : 0;
    longest = std::max(longest, row);
  }
  constexpr std::size_t kLongestName = 60, kLongestNumber = 8;
  if (text.size() > kLongestName) return Label::nothing;
  for (const char* measure :
       {"m²", "m2", "m\u00B2", "sq", "SF", "sf", "qm", "м²", "кв", "㎡", "\u00B1", "\u00D8", "=", "'"})
    if (digits > 0 && text.find(measure) != std::string::npos) return Label::nothing;
  if (stair_way(text) != 0) return Label::nothing;
  if (longest >= 2 && letters > digits) return Label::name;
  // Accepts 12, 1.04 and A-12, but not 12.50 or 1,25, which are lengths or areas.
  if (digits == 0 || text.size() > kLongestNumber || text.find_first_of(", +/") != std::string::npos)
    return Label::nothing;
  const std::size_t point = text.find('.');
  if (letters > 0 || point == std::string::npos) return Label::number;
  return text.size() - point - 1 >= 2 && text[point + 1] == '0' ? Label::number : Label::nothing;
}

}  // namespace vantage::floor_plan
