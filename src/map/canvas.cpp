// SPDX-License-Identifier: Apache-2.0
#include "map/canvas.hpp"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <string_view>

#include "core/atomic_file.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

constexpr const char* kFont = "DejaVu Sans";

struct SurfaceDeleter {
  void operator()(cairo_surface_t* s) const { cairo_surface_destroy(s); }
};
struct ContextDeleter {
  void operator()(cairo_t* c) const { cairo_destroy(c); }
};
using Surface = std::unique_ptr<cairo_surface_t, SurfaceDeleter>;
using Context = std::unique_ptr<cairo_t, ContextDeleter>;

// Releases, at its end, the references to a surface taken since. cairo 1.16 keeps one for good to a recording that it
// wrote as SVG, and with it everything drawn there.
class HeldReferences {
 public:
  explicit HeldReferences(cairo_surface_t* surface)
      : surface_(surface), before_(cairo_surface_get_reference_count(surface)) {}
  HeldReferences(const HeldReferences&) = delete;
  ~HeldReferences() {
    while (cairo_surface_get_reference_count(surface_) > before_) cairo_surface_destroy(surface_);
  }

 private:
  cairo_surface_t* surface_;
  unsigned before_;
};

cairo_status_t append_bytes(void* target, const unsigned char* data, unsigned int length) {
  static_cast<std::string*>(target)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

void require(cairo_status_t status, const std::filesystem::path& file) {
  if (status == CAIRO_STATUS_SUCCESS) return;
  throw Error(status == CAIRO_STATUS_NO_MEMORY ? Errc::out_of_memory : Errc::io,
              "cannot draw " + file.string() + ": " + cairo_status_to_string(status));
}

// Renumbers surfaces and images from 0: cairo numbers them over the life of the process, and equal pictures must be
// equal files.
std::string with_own_numbers(const std::string& svg) {
  constexpr std::string_view kNames[] = {"surface", "image", "mask", "source", "clip", "pattern"};
  const std::string_view all = svg;
  std::map<std::string_view, std::size_t> numbers;
  std::string out;
  std::size_t last = 0;
  for (std::size_t at = all.find_first_of("\"#("); at != all.npos; at = all.find_first_of("\"#(", at + 1)) {
    const std::string_view rest = all.substr(at + 1);
    const auto* const name = std::ranges::find_if(kNames, [&](std::string_view one) { return rest.starts_with(one); });
    if (name == std::end(kNames)) continue;
    const std::size_t end = std::min(rest.find_first_not_of("0123456789", name->size()), rest.size());
    if (end == name->size()) continue;
    const std::size_t number = numbers.try_emplace(rest.substr(0, end), numbers.size()).first->second;
    out.append(all, last, at + 1 + name->size() - last).append(std::to_string(number));
    last = at + 1 + end;
  }
  return out.append(all, last);
}

}  // namespace

struct Canvas::Impl {
  Surface recording;
  Context context;

  void source(const Colour& c, double opacity) const { cairo_set_source_rgba(context.get(), c.r, c.g, c.b, opacity); }
  void stroke(const Pen& pen) const {
    source(pen.colour, pen.opacity);
    cairo_set_line_width(context.get(), pen.width);
    cairo_set_dash(context.get(), pen.dashes.data(), static_cast<int>(pen.dashes.size()), 0);
    cairo_stroke(context.get());
  }
  void trace(std::span<const Point> points) const {
    cairo_new_path(context.get());  // text leaves a point at its end
    for (const Point& p : points) cairo_line_to(context.get(), p.x, p.y);
  }
  void font(const TextStyle& style) const {
    cairo_select_font_face(context.get(), kFont, CAIRO_FONT_SLANT_NORMAL,
                           style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(context.get(), style.size);
  }
};

Canvas::Canvas(double width, double height) : impl_(std::make_unique<Impl>()), width_(width), height_(height) {
  const cairo_rectangle_t extents{0, 0, width, height};
  impl_->recording.reset(cairo_recording_surface_create(CAIRO_CONTENT_COLOR_ALPHA, &extents));
  impl_->context.reset(cairo_create(impl_->recording.get()));
  cairo_set_line_join(impl_->context.get(), CAIRO_LINE_JOIN_ROUND);
  // Metrics must not depend on the device that plays the recording.
  cairo_font_options_t* options = cairo_font_options_create();
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
  cairo_set_font_options(impl_->context.get(), options);
  cairo_font_options_destroy(options);
  fill({0, 0, width, height}, {1, 1, 1});
}

Canvas::~Canvas() = default;

void Canvas::line(Point a, Point b, const Pen& pen) {
  const Point both[] = {a, b};
  path(both, pen);
}

void Canvas::path(std::span<const Point> points, const Pen& pen) {
  impl_->trace(points);
  impl_->stroke(pen);
}

void Canvas::polygon(std::span<const Point> points, const Colour& colour, double opacity) {
  impl_->trace(points);
  impl_->source(colour, opacity);
  cairo_fill(impl_->context.get());
}

void Canvas::rectangle(const Rect& r, const Pen& pen) {
  cairo_new_path(impl_->context.get());
  cairo_rectangle(impl_->context.get(), r.x, r.y, r.width, r.height);
  impl_->stroke(pen);
}

void Canvas::fill(const Rect& r, const Colour& colour, double opacity) {
  cairo_new_path(impl_->context.get());
  cairo_rectangle(impl_->context.get(), r.x, r.y, r.width, r.height);
  impl_->source(colour, opacity);
  cairo_fill(impl_->context.get());
}

void Canvas::disc(Point centre, double radius, const Colour& colour, double opacity) {
  cairo_new_path(impl_->context.get());
  cairo_arc(impl_->context.get(), centre.x, centre.y, radius, 0, 2 * std::numbers::pi);
  impl_->source(colour, opacity);
  cairo_fill(impl_->context.get());
}

void Canvas::circle(Point centre, double radius, const Pen& pen) {
  cairo_new_path(impl_->context.get());
  cairo_arc(impl_->context.get(), centre.x, centre.y, radius, 0, 2 * std::numbers::pi);
  impl_->stroke(pen);
}

double Canvas::text_width(const std::string& text, const TextStyle& style) const {
  impl_->font(style);
  cairo_text_extents_t extents;
  cairo_text_extents(impl_->context.get(), text.c_str(), &extents);
  return extents.x_advance;
}

void Canvas::text(Point at, const std::string& text, const TextStyle& style) {
  cairo_t* c = impl_->context.get();
  impl_->font(style);
  cairo_text_extents_t extents;
  cairo_text_extents(c, text.c_str(), &extents);
  const double dx = style.across == Align::start    ? 0
                    : style.across == Align::middle ? -extents.x_advance / 2
                                                    : -extents.x_advance;
  // Capitals give the height, so that words with and without descenders stand on one line.
  const double capitals = 0.73 * style.size;
  const double dy = style.down == Align::start ? capitals : style.down == Align::middle ? capitals / 2 : 0;
  cairo_save(c);
  cairo_translate(c, at.x, at.y);
  cairo_rotate(c, style.turn);
  if (style.halo > 0) {
    cairo_move_to(c, dx, dy);
    cairo_text_path(c, text.c_str());
    impl_->stroke({.colour = {1, 1, 1}, .width = 2 * style.halo, .opacity = 0.85});
  }
  cairo_move_to(c, dx, dy);
  impl_->source(style.colour, 1);
  cairo_show_text(c, text.c_str());
  cairo_restore(c);
}

void Canvas::image(const Rect& r, std::span<const std::uint32_t> pixels, std::size_t columns) {
  cairo_t* c = impl_->context.get();
  const int width = static_cast<int>(columns), height = static_cast<int>(pixels.size() / columns);
  const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_ARGB32, width, height));
  const int stride = cairo_image_surface_get_stride(surface.get()) / 4;
  auto* target = reinterpret_cast<std::uint32_t*>(cairo_image_surface_get_data(surface.get()));
  for (int y = 0; target && y < height; ++y)
    for (int x = 0; x < width; ++x)
      target[std::ptrdiff_t{y} * stride + x] =
          pixels[static_cast<std::size_t>(y) * columns + static_cast<std::size_t>(x)];
  cairo_surface_mark_dirty(surface.get());
  cairo_save(c);
  cairo_translate(c, r.x, r.y);
  cairo_scale(c, r.width / width, r.height / height);
  cairo_set_source_surface(c, surface.get(), 0, 0);
  cairo_paint(c);
  cairo_restore(c);
}

void Canvas::page(const Rect& r, const Canvas& other) {
  cairo_t* c = impl_->context.get();
  clip(r);
  cairo_translate(c, r.x, r.y);
  cairo_scale(c, r.width / other.width(), r.height / other.height());
  cairo_set_source_surface(c, other.impl_->recording.get(), 0, 0);
  cairo_paint(c);
  unclip();
}

void Canvas::clip(const Rect& r) {
  cairo_save(impl_->context.get());
  cairo_new_path(impl_->context.get());
  cairo_rectangle(impl_->context.get(), r.x, r.y, r.width, r.height);
  cairo_clip(impl_->context.get());
}

void Canvas::unclip() { cairo_restore(impl_->context.get()); }

void Canvas::save_pages(const std::filesystem::path& file, std::span<const std::unique_ptr<Canvas>> pages,
                        const std::string& title) {
  std::string bytes;
  const Surface surface(cairo_pdf_surface_create_for_stream(append_bytes, &bytes, 1, 1));
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_TITLE, title.c_str());
  const Context context(cairo_create(surface.get()));
  for (const auto& page : pages) {
    require(cairo_status(page->impl_->context.get()), file);
    cairo_pdf_surface_set_size(surface.get(), page->width(), page->height());
    cairo_set_source_surface(context.get(), page->impl_->recording.get(), 0, 0);
    cairo_paint(context.get());
    cairo_show_page(context.get());
  }
  require(cairo_status(context.get()), file);
  cairo_surface_finish(surface.get());
  require(cairo_surface_status(surface.get()), file);
  write_atomically(file, bytes);
}

void Canvas::save(const std::filesystem::path& file) const {
  require(cairo_status(impl_->context.get()), file);
  const std::string extension = file.extension().string();
  std::string bytes;
  const auto play = [&](cairo_surface_t* surface, double scale) {
    const Context context(cairo_create(surface));
    cairo_scale(context.get(), scale, scale);
    cairo_set_source_surface(context.get(), impl_->recording.get(), 0, 0);
    cairo_paint(context.get());
    require(cairo_status(context.get()), file);
  };
  if (extension == ".png") {
    const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(width_ * kPixelsPerUnit),
                                                     static_cast<int>(height_ * kPixelsPerUnit)));
    play(surface.get(), kPixelsPerUnit);
    require(cairo_surface_write_to_png_stream(surface.get(), append_bytes, &bytes), file);
  } else if (extension == ".svg") {
    const HeldReferences held(impl_->recording.get());
    const Surface surface(cairo_svg_surface_create_for_stream(append_bytes, &bytes, width_, height_));
    cairo_svg_surface_set_document_unit(surface.get(), CAIRO_SVG_UNIT_PX);
    play(surface.get(), 1);
    cairo_surface_finish(surface.get());
    require(cairo_surface_status(surface.get()), file);
    bytes = with_own_numbers(bytes);
  } else {
    throw Error(Errc::invalid_argument,
                "cannot draw " + file.string() + ": \"" + extension + "\" is neither .png nor .svg");
  }
  write_atomically(file, bytes);
}

}  // namespace vantage
