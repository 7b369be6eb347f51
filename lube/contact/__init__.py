"""Contact of rough rollers in the contact window, counted or sampled."""
