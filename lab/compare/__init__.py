"""The methods compared on one curve, as in Figure 3 of [RS21]."""
