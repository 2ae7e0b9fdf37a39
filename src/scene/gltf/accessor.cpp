// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/accessor.hpp"

#include <algorithm>
#include <cstring>

namespace vantage::gltf {
namespace {

std::size_t component_size(int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT: return 4;
    case TINYGLTF_COMPONENT_TYPE_DOUBLE: return 8;  // KHR_accessor_float64
    default: return 0;
  }
}

// glTF aligns values to the component, but a broken file may not. Its byte order is little endian, as the host's.
template <class T>
T load(const std::uint8_t* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

template <class T>
void convert(const std::uint8_t* at, std::size_t stride, std::size_t n, int components, bool normalized, double* out) {
  const double scale = normalized ? 1.0 / static_cast<double>(std::numeric_limits<T>::max()) : 1.0;
  for (std::size_t i = 0; i < n; ++i, at += stride)
    for (int c = 0; c < components; ++c) {
      const auto value = static_cast<double>(load<T>(at + static_cast<std::size_t>(c) * sizeof(T)));
      *out++ = normalized ? std::max(value * scale, -1.0) : value;
    }
}

void convert(int type, const std::uint8_t* at, std::size_t stride, std::size_t n, int components, bool normalized,
             double* out) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: return convert<std::int8_t>(at, stride, n, components, normalized, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return convert<std::uint8_t>(at, stride, n, components, normalized, out);
    case TINYGLTF_COMPONENT_TYPE_SHORT: return convert<std::int16_t>(at, stride, n, components, normalized, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return convert<std::uint16_t>(at, stride, n, components, normalized, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return convert<std::uint32_t>(at, stride, n, components, normalized, out);
    case TINYGLTF_COMPONENT_TYPE_DOUBLE: return convert<double>(at, stride, n, components, false, out);
    default: return convert<float>(at, stride, n, components, false, out);
  }
}

std::uint32_t load_index(int type, const std::uint8_t* at) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return *at;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return load<std::uint16_t>(at);
    default: return load<std::uint32_t>(at);
  }
}

bool is_index_type(int type) {
  return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

}  // namespace

Accessor::Accessor(const File& file, int index, const std::string& user, std::initializer_list<int> components)
    : file_(file) {
  const auto& accessors = file.model().accessors;
  if (index < 0 || static_cast<std::size_t>(index) >= accessors.size())
    throw file.malformed(user + " refers to accessor " + std::to_string(index) + "; there are " +
                         std::to_string(accessors.size()));
  const tinygltf::Accessor& accessor = accessors[static_cast<std::size_t>(index)];
  name_ = "accessor " + std::to_string(index) + " (" + user + ")";
  component_type_ = accessor.componentType;
  normalized_ = accessor.normalized;
  count_ = accessor.count;
  const std::size_t size = component_size(component_type_);
  if (size == 0)
    throw file.malformed(name_ + " has the component type " + std::to_string(component_type_) +
                         ", which glTF does not have");
  components_ = accessor.type == TINYGLTF_TYPE_SCALAR ? 1
                : accessor.type == TINYGLTF_TYPE_VEC2 ? 2
                : accessor.type == TINYGLTF_TYPE_VEC3 ? 3
                : accessor.type == TINYGLTF_TYPE_VEC4 ? 4
                                                      : 0;
  if (std::ranges::find(components, components_) == components.end())
    throw file.malformed(name_ + " has " +
                         (components_ == 0 ? std::string("matrices") : std::to_string(components_) + " components") +
                         " where " + std::to_string(*components.begin()) + " are needed");
  element_size_ = size * static_cast<std::size_t>(components_);
  if (accessor.bufferView >= 0) {
    const Bytes view = file.view(accessor.bufferView, name_);
    const std::size_t given = file.model().bufferViews[static_cast<std::size_t>(accessor.bufferView)].byteStride;
    stride_ = given == 0 ? element_size_ : given;
    if (stride_ < element_size_)
      throw file.malformed(name_ + " has elements of " + std::to_string(element_size_) + " bytes at a stride of " +
                           std::to_string(stride_));
    check_range(view, accessor.byteOffset, stride_, count_, element_size_, name_);
    data_ = view.data() + accessor.byteOffset;
  } else if (count_ > kLargestWithoutBuffer) {
    throw file.malformed(name_ + " has " + std::to_string(count_) + " elements but no buffer view");
  }
  if (accessor.sparse.isSparse) read_sparse(accessor);
}

bool Accessor::is_float() const { return component_type_ == TINYGLTF_COMPONENT_TYPE_FLOAT; }

void Accessor::check_range(Bytes view, std::size_t offset, std::size_t stride, std::size_t count, std::size_t size,
                           const std::string& what) const {
  const bool fits = count == 0 ? offset <= view.size()
                               : offset <= view.size() && view.size() - offset >= size &&
                                     (view.size() - offset - size) / stride >= count - 1;
  if (!fits)
    throw file_.malformed(what + " needs " + std::to_string(count) + " elements of " + std::to_string(size) +
                          " bytes from byte " + std::to_string(offset) + ", beyond its buffer view of " +
                          std::to_string(view.size()) + " bytes");
}

void Accessor::read_sparse(const tinygltf::Accessor& accessor) {
  const auto& sparse = accessor.sparse;
  const int type = sparse.indices.componentType;
  if (!is_index_type(type))
    throw file_.malformed(name_ + ": sparse indices have the component type " + std::to_string(type));
  const auto count = static_cast<std::size_t>(std::max(sparse.count, 0));
  const Bytes indices = file_.view(sparse.indices.bufferView, name_ + " sparse indices");
  const Bytes values = file_.view(sparse.values.bufferView, name_ + " sparse values");
  const auto index_offset = static_cast<std::size_t>(sparse.indices.byteOffset),
             value_offset = static_cast<std::size_t>(sparse.values.byteOffset);
  const std::size_t size = component_size(type);
  check_range(indices, index_offset, size, count, size, name_ + ": sparse indices");
  check_range(values, value_offset, element_size_, count, element_size_, name_ + ": sparse values");
  sparse_values_ = values.data() + value_offset;
  sparse_elements_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    sparse_elements_[i] = load_index(type, indices.data() + index_offset + i * size);
    if (sparse_elements_[i] >= count_)
      throw file_.malformed(name_ + ": sparse index " + std::to_string(sparse_elements_[i]) + " is beyond its " +
                            std::to_string(count_) + " elements");
    if (i > 0 && sparse_elements_[i] <= sparse_elements_[i - 1])
      throw file_.malformed(name_ + ": sparse indices do not ascend");
  }
}

void Accessor::read(std::size_t first, std::size_t n, double* out) const {
  const auto components = static_cast<std::size_t>(components_);
  if (data_) {
    convert(component_type_, data_ + first * stride_, stride_, n, components_, normalized_, out);
  } else {
    std::fill_n(out, n * components, 0.0);
  }
  const auto begin = std::ranges::lower_bound(sparse_elements_, first);
  for (auto it = begin; it != sparse_elements_.end() && *it < first + n; ++it)
    convert(component_type_, sparse_values_ + static_cast<std::size_t>(it - sparse_elements_.begin()) * element_size_,
            element_size_, 1, components_, normalized_, out + (*it - first) * components);
}

std::vector<std::uint32_t> Accessor::read_indices(std::size_t limit, bool restart) const {
  if (!is_index_type(component_type_) || normalized_)
    throw file_.malformed(name_ + " holds indices, so it must be of unsigned integers; its component type is " +
                          std::to_string(component_type_));
  std::vector<std::uint32_t> out(count_);
  if (data_)
    for (std::size_t i = 0; i < count_; ++i) out[i] = load_index(component_type_, data_ + i * stride_);
  for (std::size_t i = 0; i < sparse_elements_.size(); ++i)
    out[sparse_elements_[i]] = load_index(component_type_, sparse_values_ + i * element_size_);
  if (restart) {
    const std::uint32_t largest = kRestart >> (32 - 8 * component_size(component_type_));
    std::ranges::replace(out, largest, kRestart);
  }
  const auto bad =
      std::ranges::find_if(out, [&](std::uint32_t index) { return index >= limit && !(restart && index == kRestart); });
  if (bad != out.end())
    throw file_.malformed(name_ + ": index " + std::to_string(*bad) + " at place " + std::to_string(bad - out.begin()) +
                          ", but there are only " + std::to_string(limit) + " vertices");
  return out;
}

}  // namespace vantage::gltf
