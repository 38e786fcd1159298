// Everything that an operator can do, declared once: name, unit, how a script's rows are interpolated, default, least,
// most, meaning.
// hold = a row's value stays until the action's next row; linear = straight line from row to row.
// clang-format off
CATHLAB_ACTION(device,                 "1",     hold,   0.0,    0.0,   1.0, "the device that advance and rotate move: 0 or 'wire', 1 or 'catheter'")
CATHLAB_ACTION(advance,                "mm/s",  hold,   0.0, -100.0, 100.0, "speed at which the selected device is pushed into the sheath; negative = withdrawn")
CATHLAB_ACTION(rotate,                 "deg/s", hold,   0.0, -360.0, 360.0, "speed at which the selected device is turned at the sheath, right-handed about its direction")
CATHLAB_ACTION(proximal_bend,          "deg",   linear, 0.0,    0.0,  60.0, "bend wanted of the catheter's proximal segment")
CATHLAB_ACTION(proximal_direction,     "deg",   linear, 0.0, -720.0, 720.0, "direction of that bend about the catheter's axis")
CATHLAB_ACTION(distal_bend,            "deg",   linear, 0.0,    0.0, 140.0, "bend wanted of the catheter's distal segment")
CATHLAB_ACTION(distal_direction,       "deg",   linear, 0.0, -720.0, 720.0, "direction of that bend about the catheter's axis")
CATHLAB_ACTION(fluoroscopy,            "1",     hold,   0.0,    0.0,   1.0, "1 while the fluoroscopy pedal is down")
CATHLAB_ACTION(primary_angle,          "deg",   linear, 0.0, -180.0, 180.0, "C-arm, positive = LAO (DICOM positioner primary angle)")
CATHLAB_ACTION(secondary_angle,        "deg",   linear, 0.0,  -90.0,  90.0, "C-arm, positive = cranial (DICOM positioner secondary angle)")
CATHLAB_ACTION(table_longitudinal,     "mm",    linear, 0.0, -1000.0, 1000.0, "table, positive = towards the feet, so that the picture shows what lies nearer the head")
CATHLAB_ACTION(table_lateral,          "mm",    linear, 0.0, -200.0, 200.0, "table, positive = towards the patient's right, so that the picture shows what lies further left")
CATHLAB_ACTION(contrast,               "mL/s",  hold,   0.0,    0.0,  30.0, "flow of contrast medium from the selected device's tip")
CATHLAB_ACTION(acquisition,            "1",     hold,   0.0,    0.0,   2.0, "what the pedal exposes: 0 or 'fluoroscopy', 1 or 'cine', 2 or 'dsa' (digital subtraction)")
CATHLAB_ACTION(fluoroscopy_level,      "1",     hold,   1.0,    0.0,   2.0, "dose of fluoroscopy: 0 or 'low', 1 or 'normal', 2 or 'high'")
CATHLAB_ACTION(roadmap,                "1",     hold,   0.0,    0.0,   1.0, "1 while the fluoroscopy is shown over the vessels of the last cine or DSA series with medium in them")
CATHLAB_ACTION(reference,              "1",     hold,   0.0,    0.0,   1.0, "the picture is kept as the reference when this goes to 1")
CATHLAB_ACTION(collimator_width,       "1",     hold,   1.0,    0.1,   1.0, "share of the field's width that the collimator leaves open")
CATHLAB_ACTION(collimator_height,      "1",     hold,   1.0,    0.1,   1.0, "share of the field's height that the collimator leaves open")
// clang-format on
