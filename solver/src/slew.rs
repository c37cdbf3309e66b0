mod eigenaxis;
