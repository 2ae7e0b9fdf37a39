# Every compute shader that the library embeds. Included by the top-level list file, because CMake ties a generated file to the
# folder of the target that compiles it.
vantage_engine_shaders(vantage_scan ray_query trace/ray_query)
vantage_engine_shaders(vantage_scan compute_bvh trace/compute_bvh)
foreach(engine ray_query compute_bvh)
  vantage_shader(vantage_scan own_rays_${engine} own_rays.comp INCLUDES trace/${engine})
endforeach()
vantage_shader(vantage_scan tile_starts trace/compute_bvh/tile_starts.comp)
foreach(kernel tiles tile_list clamp reduce sample_list sample_arguments registration)
  vantage_shader(vantage_scan ${kernel} ${kernel}.comp)
endforeach()
vantage_shader(vantage_scan sample_sights sample_list.comp DEFINES SIGHTS)
vantage_shader(vantage_scan sample_queue sample_list.comp DEFINES QUEUE)
