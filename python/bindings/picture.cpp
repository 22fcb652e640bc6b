// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Pictures as arrays.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "bindings.h"
#include "lanthorn/denoise.h"
#include "lanthorn/error.h"
#include "lanthorn/text.h"
#include "plain_data.h"

namespace lanthorn::python {

Picture picture_of_state(const RenderState& state, bool with_noise_layers) {
  MeasuredPicture measured = measured_picture_of(state);
  const StateSummary summary = summarize(state);
  Picture picture{.error = std::move(measured.error),
                  .measures_exposure = summary.record.measures_exposure,
                  .display_emission = summary.record.display_emission};
  picture.image = with_noise_layers ? with_noise(state, measured.picture) : std::move(measured.picture);
  picture.image.window = summary.window;
  return picture;
}

Picture denoised(Picture picture) {
  const DenoisedPicture clean = denoise(picture.image);
  picture.image = with_denoised_light(clean.picture);
  picture.error = clean.error;
  return picture;
}

namespace {

// Indices of the channels of a layer; empty if there is no such layer.
std::vector<std::size_t> channels_of(const Image& image, const std::string& layer) {
  std::vector<std::size_t> found;
  const std::string prefix = layer == "color" ? "" : layer + ".";
  for (const char* const names : {"RGB", "XYZ"}) {
    for (const char* name = names; *name != '\0'; ++name)
      if (const auto channel = image.find_channel(prefix + *name)) found.push_back(*channel);
    if (!found.empty()) return found;
  }
  if (const auto channel = image.find_channel(layer)) return {*channel};
  if (const auto channel = image.find_channel(prefix + "Y"); layer == "color" && channel) return {*channel};
  return {};
}

// All channels: shape (height, width, channels).
ArrayLayout whole_layout(const Image& image) {
  return {type_text_of<float>(),
          {static_cast<std::size_t>(image.height), static_cast<std::size_t>(image.width), image.channel_count()}};
}

// An array of shape (height, width, channels), or (height, width) for one channel. It shares the picture's memory,
// which requires that the channels of a layer are equally spaced.
py::object layer_array(const py::object& owner, const std::string& layer) {
  const Image& image = owner.cast<const Picture&>().image;
  const std::vector<std::size_t> channels = channels_of(image, layer);
  if (channels.empty()) {
    const std::vector<std::string> known = layer_names(image);
    std::string all;
    for (const std::string& name : known) all += (all.empty() ? "" : ", ") + name;
    throw Error("the picture has no layer " + in_quotes(layer) + did_you_mean(layer, known) + " (it has " + all + ")");
  }
  constexpr auto bytes = static_cast<std::ptrdiff_t>(sizeof(float));
  const auto pixel_bytes = static_cast<std::ptrdiff_t>(image.channel_count()) * bytes;
  ArrayLayout layout = whole_layout(image);
  layout.shape.pop_back();
  layout.strides = {image.width * pixel_bytes, pixel_bytes};
  if (channels.size() > 1) {
    const auto step = static_cast<std::ptrdiff_t>(channels[1]) - static_cast<std::ptrdiff_t>(channels[0]);
    layout.shape.push_back(channels.size());
    layout.strides.push_back(step * bytes);
    for (std::size_t i = 2; i < channels.size(); ++i)
      if (static_cast<std::ptrdiff_t>(channels[i]) - static_cast<std::ptrdiff_t>(channels[i - 1]) != step)
        throw Error("the channels of the layer " + in_quotes(layer) + " are not equally spaced");
  }
  return array_in(image.pixels.data() + channels[0], layout, owner, /*writable=*/false);
}

py::object whole_array(const py::object& owner) {
  const Image& image = owner.cast<const Picture&>().image;
  return array_in(image.pixels.data(), whole_layout(image), owner, /*writable=*/false);
}

// For numpy.asarray(picture). numpy 2 passes `copy`: None copies if necessary, False forbids it.
py::object color_array(const py::object& self, const py::object& dtype, const py::object& copy) {
  const py::object array = layer_array(self, "color");
  const bool is_same = dtype.is_none() || py::module_::import("numpy").attr("dtype")(dtype).equal(array.attr("dtype"));
  if (is_same) return !copy.is_none() && copy.cast<bool>() ? array.attr("copy")() : array;
  if (!copy.is_none() && !copy.cast<bool>())
    throw py::value_error("a picture's numbers are float32: an array of another dtype must be a copy");
  return array.attr("astype")(dtype);
}

Picture picture_of_array(const py::object& data, const std::optional<std::vector<std::string>>& names) {
  Reader reader;
  const auto array = plain::number_array<float>(reader, value_of(data), "numbers of shape (height, width, channels)");
  if (array.shape.size() != 2 && array.shape.size() != 3)
    reader.fail("expected numbers of shape (height, width, channels) or (height, width), got " +
                std::to_string(array.shape.size()) + " dimensions");
  const std::size_t count = array.shape.size() == 3 ? array.shape[2] : 1;
  std::vector<std::string> channels = names.value_or(count == 3   ? std::vector<std::string>{"R", "G", "B"}
                                                     : count == 1 ? std::vector<std::string>{"Y"}
                                                                  : std::vector<std::string>{});
  if (channels.size() != count)
    reader.fail("expected " + std::to_string(count) + " names in `channels`, got " + std::to_string(channels.size()));
  Image image(static_cast<int>(array.shape[1]), static_cast<int>(array.shape[0]), std::move(channels));
  image.pixels = array.values;
  return {.image = std::move(image)};
}

DisplaySettings display_of(const Picture& picture, const std::optional<float>& exposure, const py::object& curve) {
  DisplaySettings display;
  Reader reader;
  const bool is_measured = !exposure && picture.measures_exposure;
  if (is_measured) display.curve = ToneCurve::highlights;
  if (!curve.is_none()) reader.at("curve", [&] { read(reader, curve, display.curve); });
  display.exposure = is_measured ? measured_exposure(picture.image) : exposure.value_or(0);
  display.display_emission = picture.display_emission;
  return display;
}

py::bytes png_of(const Picture& picture, const std::optional<float>& exposure, const py::object& curve) {
  const DisplaySettings display = display_of(picture, exposure, curve);
  const std::vector<unsigned char> bytes = without_gil([&] { return encode_png(picture.image, display); });
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void save(const Picture& picture, const std::filesystem::path& path, const std::optional<float>& exposure,
          const py::object& curve) {
  const DisplaySettings display = display_of(picture, exposure, curve);
  const py::gil_scoped_release release;
  write_image(path, picture.image, display);
}

void bind_error_estimate(py::module_& module) {
  py::class_<ErrorEstimate>(module, "ErrorEstimate",
                            "Estimate of a picture's error from its own samples (docs/error.md).\n\n"
                            "All numbers are relative: 0.02 is 2 % of each value.")
      .def_readonly("noise", &ErrorEstimate::noise, "float: the part that only more passes reduce.")
      .def_readonly("bias", &ErrorEstimate::bias,
                    "float: the part that shrinks with the photon radii; 0 for unbiased methods.")
      .def_readonly("error", &ErrorEstimate::error, "float: both, sqrt(noise**2 + bias**2).")
      .def_readonly("bound", &ErrorEstimate::bound, "float: upper bound of the error at 90 % confidence.")
      .def_readonly("doubt", &ErrorEstimate::doubt,
                    "str: why the numbers are too small or unknown; empty if they can be relied on.")
      .def("__repr__", [](const ErrorEstimate& e) { return "<lanthorn.ErrorEstimate " + describe_error(e) + ">"; });
}

}  // namespace

void bind_picture(py::module_& module) {
  bind_error_estimate(module);
  py::class_<Picture>(
      module, "Picture",
      "A picture of named float32 layers in linear Rec.709 colours, rows from the top.\n\n"
      "numpy.asarray(picture) is the layer 'color' with shape (height, width, 3), and picture[name] any\n"
      "other one. Arrays share the picture's memory and are read-only. Picture(array) copies an array of\n"
      "shape (height, width, 3) or (height, width); other numbers of channels need names.")
      .def(py::init(&picture_of_array), py::arg("array"), py::arg("channels") = py::none(),
           "Copies numbers of shape (height, width, channels). `channels`: names such as 'R' or 'caustic.G'.")
      .def(
          "__getitem__", &layer_array, py::arg("layer"),
          "The layer as a read-only array of float32 without a copy: shape (height, width, 3) of colours and vectors,\n"
          "(height, width) of single channels. Raises Error for layers that the picture does not have.")
      .def(
          "__contains__",
          [](const Picture& p, const std::string& layer) { return !channels_of(p.image, layer).empty(); },
          py::arg("layer"), "True if the picture has the layer.")
      .def("__array__", &color_array, py::arg("dtype") = py::none(), py::arg("copy") = py::none(),
           "The layer 'color', for numpy.asarray(picture).")
      .def_property_readonly("array", &whole_array,
                             "All channels, shape (height, width, len(channels)), float32, read-only, without a copy.")
      .def_property_readonly(
          "channels", [](const Picture& p) { return p.image.channels; },
          "list of str: names of the channels of `array`.")
      .def_property_readonly(
          "layers", [](const Picture& p) { return layer_names(p.image); }, "list of str: names for picture[name].")
      .def_property_readonly(
          "width", [](const Picture& p) { return p.image.width; }, "int: pixels.")
      .def_property_readonly(
          "height", [](const Picture& p) { return p.image.height; }, "int: pixels.")
      .def_readonly("error", &Picture::error,
                    "ErrorEstimate: the picture's estimated error; None for pictures that were not rendered.")
      .def("save", &save, py::arg("path"), py::kw_only(), py::arg("exposure") = py::none(),
           py::arg("curve") = py::none(),
           "Writes .exr (all layers), .png, .jpg or .tif, whole or not at all. `exposure`: stops; None: measured if "
           "the\n"
           "scene's file specifies none. `curve`: 'none', 'highlights', 'filmic' or 'agx'; None: 'highlights' if the\n"
           "exposure is measured, else 'none'. EXR files store linear values unchanged.")
      .def("png", &png_of, py::kw_only(), py::arg("exposure") = py::none(), py::arg("curve") = py::none(),
           "The bytes of an 8-bit sRGB PNG file of the layer 'color'. Parameters as `save`.")
      .def(
          "_repr_png_", [](const Picture& p) { return png_of(p, {}, py::none()); }, "Representation in notebooks.")
      .def("__repr__", [](const Picture& p) {
        return "<lanthorn.Picture " + std::to_string(p.image.width) + " x " + std::to_string(p.image.height) + ", " +
               std::to_string(layer_names(p.image).size()) + " layers>";
      });
  module.def(
      "load_image", [](const std::filesystem::path& path) { return Picture{.image = read_image(path)}; },
      py::arg("path"), py::call_guard<py::gil_scoped_release>(),
      "Reads an image file (EXR with all layers, HDR, PNG, JPEG, TIFF ...) as a Picture with linear colours.\n"
      "Raises Error if it cannot be read.");
}

}  // namespace lanthorn::python
