"""The server's database: its tables, its migrations, and transactions on it; SQLite or PostgreSQL."""
