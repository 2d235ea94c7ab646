// The slope in Modelica, with the reservoir as equations. Import the FMU first: in OpenModelica by
// File > FMU > Import, or importFMU("slope.fmu"); the model is then called slope_cs_FMU there. Other tools choose other
// names: change the one below. Names with dots become names in quotes or with underscores, as the tool has them.
model Valley "A reservoir fills in front of a jointed slope"
  parameter Real inflow(unit = "m2/s") = 130 "Inflow per metre of depth";
  parameter Modelica.Units.SI.Length area = 40 "Surface of the reservoir per metre of depth";
  parameter Modelica.Units.SI.Height foot = 8 "Foot of the face";
  Modelica.Units.SI.Height level(start = 6, fixed = true) "Height of the water";
  Modelica.Units.SI.Length wet "Wet height of the face";
  slope_cs_FMU slope "The FMU of examples/cases/coupled_slope.toml";
equation
  wet = max(level - foot, 0);
  area * der(level) = inflow - wet * slope.'face.velocity_x';
  slope.water_level = level;
  annotation(experiment(StopTime = 2));
end Valley;
