"""How quickly the studio's page follows a hand, and whether it lasts."""
