// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Numbers that C++ and shaders share. This text is valid in both languages (realtime/scene/layouts.h).

const float pi = 3.14159265358979f;

// Texture units.
const int unit_surfaces = 0;        // SurfaceTextures
const int unit_plastic_albedo = 1;  // plastic_albedos
const int unit_environment = 2;
const int unit_g_position = 3;  // GBuffer
const int unit_g_surface = 4;
const int unit_g_colour = 5;
const int unit_g_lobe = 6;
const int unit_map_position = 7;  // LightMaps
const int unit_map_surface = 8;
const int unit_map_colour = 9;
const int unit_visibility = 10;      // TracedShadows
const int unit_layer_emission = 11;  // light of a frame, or a mean of frames
const int unit_layer_direct = 12;
const int unit_layer_indirect = 13;
const int unit_layer_caustic = 14;
const int unit_eye_paths = 15;    // SpecularLight
const int unit_of_technique = 16;  // the first of those that each technique assigns itself

// Image units: that of a texture that a compute shader writes.
const int image_of_technique = 0;

// Bindings of storage buffers. OpenGL promises 8 of them.
const int storage_vertices = 0;  // GpuScene
const int storage_indices = 1;
const int storage_draws = 2;
const int storage_materials = 3;
const int storage_light_views = 4;    // LightMaps
const int storage_of_technique = 5;  // the first of those that each technique assigns itself

// GpuMaterial::kind.
const uint kind_diffuse = 0u;
const uint kind_metal = 1u;
const uint kind_plastic = 2u;
const uint kind_none = 3u;

// Bits of GpuMaterial::flags.
const uint flag_exact = 1u;      // the shader's closure is the material's; otherwise it is an approximation
const uint flag_textured = 2u;   // colour and width come from the layer `layer` of the surface textures
const uint flag_smooth = 4u;     // has delta lobes, which shaders leave out
const uint flag_traced = 8u;     // eye paths of the CPU find all of its light (realtime/frame/specular_light.h)
const uint flag_lobes = 16u;     // `through` and f90 come from the next layer
const uint flag_normals = 32u;   // normals come from the last of its layers
const uint flag_stand_in = 64u;  // traced, but the shader's closure may stand for it while the eye moves
const uint flag_glass = 128u;  // only delta lobes, or lobes that shaders do not support

const uint no_layer = 0xffffffffu;  // of the surface textures: the surface does not vary

// The table of the albedo of plastics: cosines by widths, and a column for the mean over the hemisphere.
const int plastic_cosines = 64;
const int plastic_widths = 17;

// LightView::kind and the number of its windows.
const int view_point = 0;
const int view_area = 1;
const int view_parallel = 2;
const int most_windows = 6;

// ShadowKind.
const int shadows_none = 0;
const int shadows_mapped = 1;
const int shadows_traced = 2;

// ToneSettings::Curve.
const int curve_clipped = 0;
const int curve_reinhard = 1;
const int curve_filmic = 2;
const int curve_agx = 3;
const int curve_highlights = 4;

// Threads of a group of one-dimensional compute shaders.
const int work_group = 64;
