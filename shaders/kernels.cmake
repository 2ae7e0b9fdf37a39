# Every compute shader that the library embeds. Included by the top-level list file, because CMake ties a generated file to the
# folder of the target that compiles it.
foreach(kernel count scan sample_trace)
  vantage_shader(vantage ${kernel}_ray_query ${kernel}.comp DEFINES ENGINE_RAY_QUERY)
  vantage_shader(vantage ${kernel}_compute_bvh ${kernel}.comp DEFINES ENGINE_COMPUTE_BVH)
endforeach()
foreach(kernel tiles tile_list tile_starts clamp reduce sample_list sample_arguments)
  vantage_shader(vantage ${kernel} ${kernel}.comp)
endforeach()
vantage_shader(vantage sample_queue sample_list.comp DEFINES QUEUE)
