# The parts of the library, each on top of those before it: what a part compiles, and which public headers are its own.
set(all_parts scan plan files report)
set(VANTAGE_UP_TO report CACHE STRING "Last part of the library to build, after all before it: scan, plan, files or report")
set_property(CACHE VANTAGE_UP_TO PROPERTY STRINGS ${all_parts})
if(NOT VANTAGE_UP_TO IN_LIST all_parts)
  message(FATAL_ERROR "VANTAGE_UP_TO is ${VANTAGE_UP_TO}; it is one of scan, plan, files, report")
endif()
list(FIND all_parts ${VANTAGE_UP_TO} last)
math(EXPR count "${last} + 1")
list(SUBLIST all_parts 0 ${count} VANTAGE_PARTS)
string(COMPARE EQUAL ${VANTAGE_UP_TO} report VANTAGE_WHOLE)

# Scenes, scanners, rays, counts, objectives, evaluated stations, sites.
set(VANTAGE_MODULES_scan core image import scene voxel placement trace scan panorama objective evaluate site)
set(VANTAGE_HEADERS_scan
    attainable error evaluate evaluation image measure objective on_site panorama placement progress rays registration scanner scene scene_builder settings simulator site
    station_setup targets trace types version work)
# Optimisers, covers, plans, scans that were taken.
set(VANTAGE_MODULES_plan optimise cover candidates search plan taken)
set(VANTAGE_HEADERS_plan candidates cover missed optimiser planner problem question search_types taken_scans)
# Point clouds, tables and pictures.
set(VANTAGE_MODULES_files map words formats)
set(VANTAGE_HEADERS_files export next pictures summary)
# Reports, sheets, and with them the folder of a plan.
set(VANTAGE_MODULES_report report)
set(VANTAGE_HEADERS_report report write_plan)
